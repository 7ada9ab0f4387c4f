#include "app/cli/info.h"

#include "app/cli/console.h"
#include "app/cli/grid_info.h"
#include "app/cli/scene_info.h"
#include "renderer/core/input_file.h"

namespace brume {
namespace {

bool is_grid_file(const std::string& path) {
  const std::string extension = lower_case_extension(path);
  return extension == ".vdb" || extension == ".nvdb";
}

Result<std::string> describe(const InfoOptions& options) {
  if (is_grid_file(options.file)) {
    const auto grids = list_grids(options.file, true);
    if (!grids) return grids.error();
    return options.json ? grids_as_json(options.file, *grids) : grids_as_text(options.file, *grids);
  }
  SceneCache cache;
  const auto loaded = load_scene(options.file, cache, {});
  if (!loaded) return loaded.error();
  const auto info = examine_scene(*loaded, cache);
  if (!info) return info.error();
  return options.json ? scene_as_json(*info) : scene_as_text(*info);
}

}  // namespace

Result<ExitCode> run_info(const InfoOptions& options) {
  const auto text = describe(options);
  if (!text) return text.error();
  if (auto done = print_result(*text); !done) return done.error();
  return ExitCode::Ok;
}

}  // namespace brume
