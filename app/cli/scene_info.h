// A scene, described.
#pragma once

#include <string>
#include <vector>

#include "app/session/load_scene.h"
#include "renderer/scene/scene.h"

namespace brume {

struct SceneInfo {
  LoadedScene loaded;
  std::shared_ptr<const Scene> scene;
  std::vector<Bounds3> volume_bounds;  ///< world space, of the description's volumes; empty where one is switched off
};

/// Reads the grids of the scene, too. Errors are those of committing it.
Result<SceneInfo> examine_scene(const LoadedScene& loaded, SceneCache& cache);

std::string scene_as_text(const SceneInfo& info);
std::string scene_as_json(const SceneInfo& info);

}  // namespace brume
