// What a rendering cost, for --stats.
#pragma once

#include <string>

#include "renderer/engine/engine.h"

namespace brume {

struct RenderReport {
  std::string scene_file, output;
  const Scene& scene;
  const RenderStatistics& statistics;
  double noise = 0;          ///< as Film::noise_estimate()
  double load_seconds = 0;   ///< before the first sample: reading files, building grids
  bool interrupted = false;  ///< fewer samples than asked for
};

/// A JSON object. Times in seconds, lengths in world units, counts over the whole picture.
std::string format_report(const RenderReport& report);

}  // namespace brume
