// What the mouse does to the camera.
#pragma once

#include "renderer/params/node.h"

namespace brume {

/// Turns about the look-at point: `right` about the camera's up axis, `up` towards or away from it, both in radians.
/// Stops short of the poles, where the picture would flip.
void orbit(Node& camera, double right, double up);

/// Moves camera and look-at point together in the picture plane, in heights of the picture at the look-at point.
void pan(Node& camera, double right, double up);

/// Multiplies the distance from the look-at point, in (0, infinity).
void dolly(Node& camera, double factor);

}  // namespace brume
