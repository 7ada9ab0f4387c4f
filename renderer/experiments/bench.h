// How fast this machine renders, and how fast it could.
#pragma once

#include <functional>
#include <optional>

#include "renderer/scene/scene.h"

namespace brume {

struct BenchResult {
  std::string name;
  double value;
  std::string unit;
  std::optional<double> limit = {};  ///< what limit kernels, run beside it, say about this machine; in the same unit
  std::optional<double> goal = {};   ///< for the ratio, or for the value where nothing limits it

  /// Of the value to its limit; above 1: slower than the limit.
  std::optional<double> ratio() const { return limit ? std::optional(value / *limit) : std::nullopt; }
};

struct BenchOptions {
  std::string scenes;     ///< folder of the scenes that ship
  std::string only = {};  ///< part of the names of what is measured; empty: everything
  /// Called before each measurement with its name.
  std::function<void(const std::string&)> progress = {};
};

/// Measures one thing after the other, some fifteen seconds in all. Every time is the least of several repetitions,
/// because other programs only ever add time. Errors: a scene that cannot be read.
Result<std::vector<BenchResult>> run_bench(const BenchOptions& options);

}  // namespace brume
