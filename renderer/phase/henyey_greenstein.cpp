#include "renderer/phase/henyey_greenstein.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/phase/henyey_greenstein.cpp"
#include <hwy/foreach_target.h>  // compiles this file once per instruction set

#include <hwy/highway.h>

#include "renderer/core/simd.h"
#include "renderer/sampling/warps.h"

HWY_BEFORE_NAMESPACE();
namespace brume::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// out[i] = scale / (least + slope (1 - sign cos_theta[i]))^(3/2)
void Values(const float* cos_theta, int n, float least, float slope, float sign, float scale, float* out) {
  const hn::CappedTag<float, kWidestVector> d;
  const auto set = [d](float v) HWY_ATTR { return hn::Set(d, v); };
  const auto one = set(1), two = set(2), zero = hn::Zero(d);
  for (int i = 0; i < n; i += static_cast<int>(hn::Lanes(d))) {
    const auto from_peak = hn::NegMulAdd(set(sign), hn::Load(d, cos_theta + i), one);
    const auto denominator = hn::MulAdd(set(slope), hn::Min(hn::Max(from_peak, zero), two), set(least));
    hn::Store(hn::Div(set(scale), hn::Mul(denominator, hn::Sqrt(denominator))), d, out + i);
  }
}

}  // namespace
}  // namespace brume::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume {

HWY_EXPORT(Values);

// 1 - |g| is small where it matters most: what is made of it is made in double.
HenyeyGreenstein::HenyeyGreenstein(double g) : g_(std::clamp(g, -0.9999, 0.9999)) {
  const double a = std::abs(g_);
  least_ = static_cast<float>((1 - a) * (1 - a));
  slope_ = static_cast<float>(2 * a);
  scale_ = kInv4Pi * static_cast<float>((1 - a) * (1 + a));
}

float HenyeyGreenstein::value(float cos_theta) const {
  // 1 + g^2 - 2 g c without cancellation where it is smallest: (1 - |g|)^2 + 2 |g| (1 - c sign g).
  const float denominator = least_ + slope_ * std::clamp(g_ < 0 ? 1 + cos_theta : 1 - cos_theta, 0.0f, 2.0f);
  return scale_ / (denominator * std::sqrt(denominator));
}

void HenyeyGreenstein::values(const float* cos_theta, int n, float* out) const {
  HWY_DYNAMIC_DISPATCH(Values)(cos_theta, n, least_, slope_, g_ < 0 ? -1.0f : 1.0f, scale_, out);
}

PhaseSample HenyeyGreenstein::sample(Vec3 direction, Vec2 u) const {
  // The textbook inverse, cos = (1 + g^2 - ((1 - g^2) / d)^2) / (2 g) with s = 1 - 2u and d = 1 + g s, divides by g and
  // cancels near |g| = 1. On paper (1 + g) - d = g (1 - s), so one g cancels and every factor is positive:
  //   1 - cos = (1 - g)^2 (1 - s) (2 + g + g s) / (2 d^2),
  // which at g = 0 is 1 - s. Negative g is the mirror image.
  const double g = std::abs(g_), x = static_cast<double>(u.x);
  const double d = (1 - g) + 2 * g * (1 - x);
  const float one_minus_cos =
      static_cast<float>(std::min(2.0, (1 - g) * (1 - g) * x * (2 + 2 * g * (1 - x)) / (d * d)));
  // For g < 0 the angle is taken from the opposite direction.
  const Vec3 axis = g_ < 0 ? -direction : direction;
  const float cos_theta = g_ < 0 ? one_minus_cos - 1 : 1 - one_minus_cos;
  return {direction_about(axis, one_minus_cos, u.y), value(cos_theta)};
}

}  // namespace brume
#endif  // HWY_ONCE
