// brume compare: how far one picture is from another.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/cli/exit_code.h"
#include "renderer/analysis/metric.h"

namespace brume {

struct CompareOptions {
  std::string test, reference;       ///< EXR, or PNG as sRGB
  std::vector<std::string> metrics;  ///< by their keys; empty: all
  std::string output;                ///< picture of the differences, .png; empty: none
  std::optional<double> threshold;   ///< of the only metric; beyond it the check has failed
  Viewing viewing;                   ///< for what is seen
  bool json = false;
};

Result<ExitCode> run_compare(const CompareOptions& options);

}  // namespace brume
