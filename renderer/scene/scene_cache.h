// What scenes have read and baked so far, shared by the scenes made of it.
#pragma once

#include "renderer/geometry/mesh.h"
#include "renderer/lights/registry.h"
#include "renderer/media/bake.h"
#include "renderer/media/grid_cache.h"

namespace brume {

struct SceneCache {
  GridCache grids;
  BakeCache baked;
  FileCache<EnvironmentMap> pictures;
  FileCache<Mesh> meshes;

  /// Forgets what no scene holds.
  void drop_unused() { grids.drop_unused(), baked.drop_unused(), pictures.drop_unused(), meshes.drop_unused(); }
};

}  // namespace brume
