// Axis-aligned boxes and intervals along a ray.
#pragma once

#include <limits>

#include "renderer/core/vec.h"

namespace brume {

/// Part of a ray, t in world units; empty unless begin < end.
struct Interval {
  float begin = 0, end = 0;
  constexpr bool empty() const { return !(begin < end); }
  constexpr float length() const { return end - begin; }
};

constexpr Interval intersect(Interval a, Interval b) { return {std::max(a.begin, b.begin), std::min(a.end, b.end)}; }

/// Empty when any low component exceeds the high one, as when default-constructed.
struct Bounds3 {
  Vec3d low{std::numeric_limits<double>::infinity()};
  Vec3d high{-std::numeric_limits<double>::infinity()};

  bool empty() const { return !(low.x <= high.x && low.y <= high.y && low.z <= high.z); }
  Vec3d center() const { return (low + high) * 0.5; }
  Vec3d extent() const { return high - low; }
  double diagonal() const { return length(extent()); }
  Vec3d corner(int i) const { return {(i & 1) ? high.x : low.x, (i & 2) ? high.y : low.y, (i & 4) ? high.z : low.z}; }
  void add(Vec3d p) { low = min(low, p), high = max(high, p); }
  void add(const Bounds3& b) {
    if (!b.empty()) add(b.low), add(b.high);
  }
};

}  // namespace brume
