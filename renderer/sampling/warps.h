// Maps from uniform numbers to directions and points, each beside its density.
#pragma once

#include "renderer/core/vec.h"

namespace brume {

/// Uniform on the unit sphere.  @param u in [0,1)^2
inline Vec3 uniform_sphere(Vec2 u) {
  const float z = 1 - 2 * u.x, r = std::sqrt(std::max(0.0f, 1 - z * z)), phi = 2 * kPi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), z};
}
constexpr float uniform_sphere_pdf() { return kInv4Pi; }  ///< per sr

}  // namespace brume
