#include "app/cli/snapshot.h"

#include "app/cli/console.h"
#include "app/cli/output_file.h"

namespace brume {

Result<ExitCode> run_snapshot_command(const SceneOptions& scene, const SnapshotOptions& options) {
  if (auto done = check_output(options.output, {".png"}); !done) return done.error();
  SceneCache cache;
  auto loaded = load_scene(scene, cache, {});
  if (!loaded) return loaded.error();
  if (auto done = run_snapshot(std::move(*loaded), options); !done) return done.error();
  print_note("wrote " + options.output);
  return ExitCode::Ok;
}

}  // namespace brume
