// brume chart: speed against accuracy, measured.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/cli/exit_code.h"
#include "app/cli/scene_options.h"

namespace brume {

struct ChartOptions {
  SceneOptions scene;
  std::vector<std::string> outputs;  ///< .svg, .png, .csv
  std::vector<std::string> variants, methods, steps, light_samples, bounces;
  std::string x = "cpu_seconds", y = "rmse";
  std::string title;
  double seconds = 5;  ///< of processor time for each variant
  std::optional<int> samples;
  std::string reference;  ///< .exr; empty: it is rendered
  double reference_seconds = 60;
  bool front = false;  ///< marks the cheapest for their error
  std::optional<double> target;
  std::string best;  ///< scene file to write with the winner's settings; empty: none
  bool light = true;
  int width = 960, height = 560, threads = 0;
};

Result<ExitCode> run_chart(const ChartOptions& options);

}  // namespace brume
