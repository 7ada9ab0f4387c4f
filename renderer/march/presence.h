// Which media a ray is in, and where.
#pragma once

#include "renderer/core/arena.h"
#include "renderer/media/medium.h"

namespace brume {

/// The presence of every medium along one ray. Lives in the arena of the scope that was open when it was found.
struct Presence {
  std::span<std::span<const Interval>> of_medium;
  std::span<float> edges;  ///< where any medium begins or ends, ascending, each once; fewer than 2: no medium at all

  bool empty() const { return edges.size() < 2; }
  /// The begin of an interval counts as inside: in a dense medium a free flight may be too short to leave it.
  bool contains(std::size_t medium, float t) const;
};

Presence find_presence(std::span<const Medium> media, const Ray& ray, Arena& arena);

}  // namespace brume
