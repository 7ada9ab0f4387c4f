// Where a thing stands, as a scene file says it.
#pragma once

#include "renderer/core/transform.h"
#include "renderer/params/node.h"

namespace brume {

const Family& transform_family();

/// Invertible.  Errors name the key.
Result<Affined> world_from_local(const Node& transform);

/// A vector of any length but 0, made unit.  Errors name the key.
Result<Vec3d> direction_of(const Node& node, const char* key);

}  // namespace brume
