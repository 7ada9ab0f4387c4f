#include "renderer/phase/rayleigh.h"

#include "renderer/sampling/warps.h"

namespace brume {

float Rayleigh::value(float cos_theta) const {
  const float c = std::clamp(cos_theta, -1.0f, 1.0f);
  return 0.75f * kInv4Pi * (1 + c * c);
}

PhaseSample Rayleigh::sample(Vec3 direction, Vec2 u) const {
  // The distribution function (c^3 + 3 c + 4) / 8 = u is a cubic with one real root; with c = 2 sinh(x) it reads
  // 2 sinh(3 x) = 8 u - 4.
  const float c = std::clamp(2 * std::sinh(std::asinh(4 * u.x - 2) / 3), -1.0f, 1.0f);
  return {direction_about(direction, 1 - c, u.y), value(c)};
}

}  // namespace brume
