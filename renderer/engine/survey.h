// A rough look at a scene, before or instead of rendering it.
#pragma once

#include <string>
#include <vector>

#include "renderer/scene/scene.h"

namespace brume {

/// Optical depths (mean of the channels) of a grid of camera rays up to the first surface, 0 for those that miss every
/// medium.
std::vector<float> optical_depths(const Scene& scene, int columns, int rows);

/// Whether any light reaches any of a handful of places in the media; only surfaces keep it away.
bool light_arrives(const Scene& scene);

/// Two significant digits: a value that people can read and change.
double two_digits(double v);

/// For sentences: three digits.
std::string short_number(double v);

}  // namespace brume
