// Whose turn it is when several pictures share the threads.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace brume {

/// What jobs that share the threads get alike.
enum class Share { EqualTime, EqualSamples };

/// What one job has had so far.
struct Turn {
  bool waits;          ///< it has work left and may do it now
  bool shown;          ///< a first picture of it has been published
  double samples;      ///< per pixel, with the fraction of the pass under way
  double cpu_seconds;  ///< of its own work
};

/// The job that is next: one that has shown nothing yet, else the one that has had least. Of several that have shown
/// nothing it is the first at or after `first_look`, cyclically: edits that come faster than pictures must not starve
/// the last of them.
/// @return an index, nothing when no job waits
std::optional<std::size_t> next_turn(std::span<const Turn> jobs, Share share, std::size_t first_look = 0);

}  // namespace brume
