#include "app/cli/snapshot.h"

#include "app/cli/console.h"
#include "app/cli/output_file.h"

namespace brume {

Result<ExitCode> run_snapshot_command(const SceneOptions& scene, SnapshotOptions options) {
  if (auto done = check_output(options.output, {".png"}); !done) return done.error();
  options.file = scene.file;
  for (const Setting& setting : scene.settings) options.overrides.emplace_back(setting.key, setting.text);
  if (auto done = run_snapshot(options); !done) return done.error();
  print_note("wrote " + options.output);
  return ExitCode::Ok;
}

}  // namespace brume
