// Placing the camera so that everything is in view.
#pragma once

#include "renderer/core/bounds.h"
#include "renderer/params/node.h"

namespace brume {

/// Moves the camera along its present line of sight so that the sphere round `bounds` fills the smaller side of the
/// picture, and looks at its centre. Leaves the field of view; does nothing for empty bounds.
/// @param camera  of camera_family().  @param bounds  world space.  @param aspect  width / height
void frame_bounds(Node& camera, const Bounds3& bounds, double aspect);

}  // namespace brume
