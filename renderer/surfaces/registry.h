// The surfaces a scene file can name.
#pragma once

#include "renderer/core/file_cache.h"
#include "renderer/geometry/surface.h"
#include "renderer/surfaces/material.h"

namespace brume {

const Family& surface_family();

struct MadeSurface {
  std::shared_ptr<const Surface> surface;
  Material material;
};

/// @param scene_origin  world position that is (0,0,0) of the scene.  Errors name the key.
Result<MadeSurface> make_surface(const Node& node, Vec3d scene_origin, FileCache<Mesh>& meshes);

}  // namespace brume
