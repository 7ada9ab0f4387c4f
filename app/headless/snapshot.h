// The whole user interface as a picture, without a display.
#pragma once

#include "app/session/load_scene.h"

namespace brume {

struct SnapshotOptions {
  std::string output;  ///< .png
  int width = 1400, height = 900;
  bool chart = false;   ///< with the chart of errors, for which the reference is waited for
  bool search = false;  ///< with the chart of what a search for the cheapest settings has found
  bool probe = false;   ///< with the probe of the pixel in the middle
  int samples = 16;     ///< per pixel
};

Result<void> run_snapshot(LoadedScene scene, const SnapshotOptions& options);

}  // namespace brume
