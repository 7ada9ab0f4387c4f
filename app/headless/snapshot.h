// The whole user interface as a picture, without a display.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "renderer/core/error.h"

namespace brume {

struct SnapshotOptions {
  std::string file;    ///< scene, grid file, or picture made by Brume
  std::string output;  ///< .png
  int width = 1400, height = 900;
  int samples = 16;                                            ///< per pixel
  std::vector<std::pair<std::string, std::string>> overrides;  ///< key, value as for --set
};

Result<void> run_snapshot(const SnapshotOptions& options);

}  // namespace brume
