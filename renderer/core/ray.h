// Rays.
#pragma once

#include "renderer/core/bounds.h"
#include "renderer/core/vec.h"

namespace brume {

/// The points origin + t direction with t in `span`; `direction` is unit, so t is in world units.
struct Ray {
  Vec3 origin;
  Vec3 direction;
  Interval span = {0, std::numeric_limits<float>::infinity()};

  Vec3 at(float t) const { return origin + direction * t; }
};

}  // namespace brume
