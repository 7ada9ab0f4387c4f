// The shapes a scene file can name as the bounds of a volume.
#pragma once

#include "renderer/geometry/shape.h"
#include "renderer/params/node.h"

namespace brume {

const Family& shape_family();

/// Errors name the key.
Result<std::unique_ptr<const Shape>> make_shape(const Node& node);

}  // namespace brume
