#include "renderer/phase/henyey_greenstein.h"

#include "renderer/sampling/warps.h"

namespace brume {

HenyeyGreenstein::HenyeyGreenstein(float g) : g_(std::clamp(g, -0.999f, 0.999f)) {}

float HenyeyGreenstein::value(float cos_theta) const {
  const float c = std::clamp(cos_theta, -1.0f, 1.0f);
  // 1 + g^2 - 2 g c without cancellation where it is smallest: (1 - |g|)^2 + 2 |g| (1 - c sign g).
  const float a = std::abs(g_);
  const float denominator = (1 - a) * (1 - a) + 2 * a * (1 - (g_ < 0 ? -c : c));
  return kInv4Pi * (1 - g_ * g_) / (denominator * std::sqrt(denominator));
}

PhaseSample HenyeyGreenstein::sample(Vec3 direction, Vec2 u) const {
  // The textbook inverse, cos = (1 + g^2 - ((1 - g^2) / d)^2) / (2 g) with s = 1 - 2u and d = 1 + g s, divides by g and
  // cancels near |g| = 1. On paper (1 + g) - d = g (1 - s), so one g cancels and every factor is positive:
  //   1 - cos = (1 - g)^2 (1 - s) (2 + g + g s) / (2 d^2),
  // which at g = 0 is 1 - s. Negative g is the mirror image.
  const float g = std::abs(g_);
  const float d = (1 - g) + 2 * g * (1 - u.x);
  const float one_minus_cos = std::min(2.0f, (1 - g) * (1 - g) * u.x * (2 + 2 * g * (1 - u.x)) / (d * d));
  // For g < 0 the angle is taken from the opposite direction.
  const Vec3 axis = g_ < 0 ? -direction : direction;
  const float cos_theta = std::copysign(1.0f, g_) * (1 - one_minus_cos);
  return {direction_about(axis, one_minus_cos, u.y), value(cos_theta)};
}

}  // namespace brume
