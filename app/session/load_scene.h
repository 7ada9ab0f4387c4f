// Scenes from any file that holds or implies one, and pictures to files.
#pragma once

#include <string>
#include <vector>

#include "renderer/engine/engine.h"
#include "renderer/params/node.h"
#include "renderer/scene/scene_cache.h"

namespace brume {

struct LoadedScene {
  Node description;
  std::string file;        ///< as it was named
  std::string scene_path;  ///< where Save writes: the scene file, empty for what was made up or taken from a picture
  std::vector<std::string> notes;  ///< one sentence each: what was chosen
};

/// FILE.json; a grid file (.vdb, .nvdb), through first_look(); or a picture that Brume wrote (.exr, .png), which holds
/// its scene.
Result<LoadedScene> load_scene(const std::string& path, SceneCache& cache, const LoadOptions& options);

/// commit(), whose errors then name the file.
Result<std::shared_ptr<const Scene>> commit_loaded(const LoadedScene& loaded, SceneCache& cache,
                                                   const CommitOptions& options = {});

/// Linear values (.exr) or display values by the film's exposure and curve (.png), with the scene inside and, under
/// "samples_per_pixel", what was spent on it.
Result<void> write_picture(const std::string& path, const Picture& picture, const Node& description);

}  // namespace brume
