// How loads report, are stopped, and are kept from taking more memory than there is.
#pragma once

#include <cstdint>
#include <functional>
#include <stop_token>

#include "renderer/core/error.h"

namespace brume {

struct LoadOptions {
  /// Called now and then with a number that grows from 0 to 1, from any thread but never from two at once.
  std::function<void(float)> progress = {};
  /// When stop is requested, the work is given up soon and returns ErrorCode::Cancelled.
  std::stop_token cancel = {};
  /// Voxels are kept as floats instead of half floats.
  bool full_precision = true;
};

/// The same options, with progress running over [from, to] only. Refers to `options`.
LoadOptions part_of(const LoadOptions& options, float from, float to);

Error loading_cancelled();

/// Runs body(i) for i in [0, n) on all hardware threads; reports progress from `from` to `to`; false when cancelled.
bool parallel_load(std::int64_t n, const LoadOptions& options, float from, float to,
                   const std::function<void(std::int64_t)>& body);

/// An error when `bytes` is more than the machine's physical memory; asked before memory is taken, for Linux grants
/// more than there is and later ends the program.
Result<void> check_memory(std::uint64_t bytes);

}  // namespace brume
