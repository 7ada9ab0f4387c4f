// Where a light may be, seen from a ray.
#pragma once

#include <cmath>

#include "renderer/core/ray.h"

namespace brume {

/// Angle under which the pivot (foot at 0, distance D) sees [a, b]; a difference that is safe for moderate values.
inline double angle(double a, double b, double D) { return std::atan2(D * (b - a), D * D + a * b); }

struct Placement {
  const char* what;
  double foot, distance;
  Interval span;
};

inline constexpr Placement kPlacements[] = {
    {"pivot beside the middle", 5, 1, {0, 10}},        {"pivot close to the ray", 3, 1e-3, {0, 10}},
    {"pivot very close to the ray", 3, 1e-6, {0, 10}}, {"pivot far from the ray", 5, 1e4, {0, 10}},
    {"foot before the span", -3, 2, {1, 4}},           {"foot behind the span", 9, 2, {1, 4}},
    {"foot just outside", 0.999, 1e-6, {1, 4}},        {"foot on the begin of the span", 1, 0.1, {1, 4}},
    {"foot on the end of the span", 4, 0.1, {1, 4}},   {"foot far away", -1000, 1, {0, 1}},
};

}  // namespace brume
