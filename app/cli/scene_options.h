// The part of the command line that says what scene is meant.
#pragma once

#include <string>
#include <vector>

#include "app/session/load_scene.h"

namespace brume {

/// One value of the description, changed by a flag.
struct FlagSetting {
  std::string flag;  ///< as errors name it: "--size", "--set render.bounces"
  std::string key;   ///< "film.resolution"
  std::string text;
};

struct SceneOptions {
  std::string file;                   ///< .json, .vdb, .nvdb, or a picture that Brume wrote
  std::vector<FlagSetting> settings;  ///< applied in this order
};

/// Splits what follows --set at its first "=".
Result<FlagSetting> parse_setting(const std::string& text);

/// Applies one setting. A file that it names by a relative path is meant from the current directory (in a scene file it
/// would be from the file's folder).
Result<void> apply_setting(Node& description, const FlagSetting& setting);

/// Loads the file and applies the settings.
Result<LoadedScene> load_scene(const SceneOptions& options, SceneCache& cache, const LoadOptions& load_options);

}  // namespace brume
