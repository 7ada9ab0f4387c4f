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

/// The direction at the angle theta from `axis`, at the azimuth 2 pi u. Takes 1 - cos(theta), which stays exact where
/// the cosine itself rounds to 1.
inline Vec3 direction_about(Vec3 axis, float one_minus_cos, float u) {
  const float sin_theta = std::sqrt(std::max(0.0f, one_minus_cos * (2 - one_minus_cos))), phi = 2 * kPi * u;
  return normalize(Frame(axis).to_world({sin_theta * std::cos(phi), sin_theta * std::sin(phi), 1 - one_minus_cos}));
}

/// Uniform in the cone of directions at most theta from `axis`; pdf 1 / (2 pi (1 - cos(theta))) per sr.
inline Vec3 uniform_cone(Vec3 axis, float one_minus_cos_max, Vec2 u) {
  return direction_about(axis, u.x * one_minus_cos_max, u.y);
}

/// Uniform on the unit disc.
inline Vec2 uniform_disc(Vec2 u) {
  const float r = std::sqrt(u.x), phi = 2 * kPi * u.y;
  return {r * std::cos(phi), r * std::sin(phi)};
}

/// On the side of `normal`, with the pdf cosine / pi per sr.
inline Vec3 cosine_hemisphere(Vec3 normal, Vec2 u) {
  const Vec2 p = uniform_disc(u);
  const float height = std::sqrt(std::max(0.0f, 1 - u.x));  // u.x is the squared radius
  return normalize(Frame(normal).to_world({p.x, p.y, height}));
}

}  // namespace brume
