// brume render: a scene to a picture file.
#pragma once

#include <optional>

#include "app/cli/exit_code.h"
#include "app/cli/scene_options.h"

namespace brume {

inline constexpr int kDefaultSamples = 16;

struct RenderOptions {
  SceneOptions scene;
  std::string output;             ///< .exr or .png
  std::optional<int> samples;     ///< per pixel; of samples and seconds at most one is given
  std::optional<double> seconds;  ///< of rendering: as many passes as come nearest to it, at least one
  int threads = 0;                ///< 0: as many as the machine has
  std::string statistics_file;    ///< empty: none
};

/// Everything that can be refused is refused before the first sample. Ctrl+C saves the samples there are.
/// A picture with the same scene, seed and samples has the same bits at any number of threads.
Result<ExitCode> run_render(const RenderOptions& options);

}  // namespace brume
