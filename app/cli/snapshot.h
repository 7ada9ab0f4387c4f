// brume snapshot: the whole interface as a picture.
#pragma once

#include "app/cli/exit_code.h"
#include "app/cli/scene_options.h"
#include "app/headless/snapshot.h"

namespace brume {

/// @param scene  what the interface shows
Result<ExitCode> run_snapshot_command(const SceneOptions& scene, const SnapshotOptions& options);

}  // namespace brume
