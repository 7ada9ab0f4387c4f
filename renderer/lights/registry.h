// The lights a scene file can name.
#pragma once

#include <memory>

#include "renderer/lights/light.h"
#include "renderer/params/node.h"

namespace brume {

struct LightType {
  const ParamTable* table;
  /// @param scene_origin  world position that is (0,0,0) of the scene
  Result<std::unique_ptr<Light>> (*make)(const Node&, Vec3d scene_origin);
};

const std::vector<LightType>& light_types();
const Family& light_family();

/// @param node  of one of light_types(); errors name the key
Result<std::unique_ptr<const Light>> make_light(const Node& node, Vec3d scene_origin);

}  // namespace brume
