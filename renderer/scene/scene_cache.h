// What scenes have read from files so far, shared by the scenes made of it.
#pragma once

#include "renderer/lights/registry.h"
#include "renderer/media/grid_cache.h"

namespace brume {

struct SceneCache {
  GridCache grids;
  FileCache<EnvironmentMap> pictures;

  /// Forgets what no scene holds.
  void drop_unused() { grids.drop_unused(), pictures.drop_unused(); }
};

}  // namespace brume
