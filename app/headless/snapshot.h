// The whole user interface as a picture, without a display.
#pragma once

#include "app/session/load_scene.h"

namespace brume {

struct SnapshotOptions {
  std::string output;  ///< .png
  int width = 1400, height = 900;
  bool chart = false;  ///< with the chart of errors, for which the reference is waited for
  int samples = 16;    ///< per pixel
};

Result<void> run_snapshot(LoadedScene scene, const SnapshotOptions& options);

}  // namespace brume
