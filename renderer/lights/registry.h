// The lights a scene file can name.
#pragma once

#include <memory>

#include "renderer/core/file_cache.h"
#include "renderer/geometry/mesh.h"
#include "renderer/lights/environment_map.h"
#include "renderer/lights/light.h"
#include "renderer/params/node.h"

namespace brume {

/// What making a light needs besides its description.
struct LightContext {
  Vec3d scene_origin;  ///< world position that is (0,0,0) of the scene
  FileCache<EnvironmentMap>& pictures;
  FileCache<Mesh>& meshes;
};

struct MadeLight {
  std::unique_ptr<Light> light;
  std::vector<std::string> warnings = {};
};

struct LightType {
  const ParamTable* table;
  Result<MadeLight> (*make)(const Node&, const LightContext&);
};

const std::vector<LightType>& light_types();
const Family& light_family();

/// @param node  of one of light_types(); errors name the key
Result<MadeLight> make_light(const Node& node, const LightContext& context);

}  // namespace brume
