// What tells two descriptions apart.
#pragma once

#include <optional>

#include "renderer/params/node.h"

namespace brume {

/// The dearest of the changes between two descriptions, nothing when they are equal. Another kind of object, or another
/// number of objects in a list, counts as Geometry.
std::optional<Affects> node_difference(const Node& a, const Node& b);

}  // namespace brume
