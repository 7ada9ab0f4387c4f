// Which media a ray is in, and where.
#pragma once

#include <algorithm>

#include "renderer/core/arena.h"
#include "renderer/media/medium.h"

namespace brume {

/// The presence of every medium along one ray. Lives in the arena of the scope that was open when it was found.
struct Presence {
  std::span<std::span<const Interval>> of_medium;
  std::span<float> edges;  ///< where any medium begins or ends, ascending, each once; fewer than 2: no medium at all
  std::size_t only = 0;    ///< the medium that is alone on the ray, or the number of media

  bool empty() const { return edges.size() < 2; }
  /// The begin of an interval counts as inside: in a dense medium a free flight may be too short to leave it.
  bool contains(std::size_t medium, float t) const {
    const auto& intervals = of_medium[medium];
    return std::any_of(intervals.begin(), intervals.end(), [t](Interval i) { return t >= i.begin && t < i.end; });
  }
};

Presence find_presence(std::span<const Medium> media, const Ray& ray, Arena& arena);

}  // namespace brume
