#include "renderer/march/product_weights.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/march/product_weights.cpp"
#include <hwy/foreach_target.h>  // compiles this file once per instruction set

#include <hwy/highway.h>

#include "renderer/core/simd.h"

HWY_BEFORE_NAMESPACE();
namespace brume::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kWidestVector>;
using V = hn::Vec<D>;

void LightCosines(const float* t, int n, const ProductTerms& terms, float* cosine) {
  const D d;
  const V foot = hn::Set(d, terms.foot), off2 = hn::Set(d, terms.off_ray * terms.off_ray);
  const V least = hn::Set(d, 1e-30f);
  for (int i = 0; i <= n; i += static_cast<int>(hn::Lanes(d))) {
    const V s = hn::Sub(foot, hn::LoadU(d, t + i));
    const V r = hn::Sqrt(hn::Max(hn::MulAdd(s, s, off2), least));
    hn::Store(hn::Div(s, r), d, cosine + i);
  }
}

void ProductWeights(const float* t, const float* p, const float* phase, int n, const ProductTerms& terms, float* weight,
                    float* angle) {
  const D d;
  const V half = hn::Set(d, 0.5f), foot = hn::Set(d, terms.foot), zero = hn::Zero(d);
  const V near2 = hn::Set(d, terms.distance * terms.distance);
  const V height = hn::Set(d, terms.height), slope = hn::Set(d, terms.slope);
  for (int i = 0; i < n; i += static_cast<int>(hn::Lanes(d))) {
    const V begin = hn::LoadU(d, t + i), end = hn::LoadU(d, t + i + 1), middle = hn::Mul(half, hn::Add(begin, end));
    const V s = hn::Sub(middle, foot);
    const V r2 = hn::MulAdd(s, s, near2), scattered = hn::Load(d, p + i), inverse = hn::Div(hn::Set(d, 1.0f), r2);
    V w = hn::Mul(scattered, inverse);
    const V seen = hn::Mul(hn::Sub(end, begin), inverse);
    hn::Store(hn::IfThenElseZero(hn::Gt(scattered, zero), seen), d, angle + i);
    if (phase) w = hn::Mul(w, hn::Mul(half, hn::Add(hn::Load(d, phase + i), hn::LoadU(d, phase + i + 1))));
    if (terms.flat) {
      V at_begin = hn::MulAdd(slope, begin, height), at_end = hn::MulAdd(slope, end, height);
      V at_middle = hn::MulAdd(slope, middle, height);
      if (terms.two_sided) {
        at_begin = hn::Abs(at_begin), at_end = hn::Abs(at_end), at_middle = hn::Abs(at_middle);
      }
      const V least = hn::Mul(hn::Set(d, 0.25f), hn::Max(at_begin, at_end));
      w = hn::Div(hn::Mul(w, hn::Max(hn::Max(at_middle, least), zero)), hn::Sqrt(r2));
    }
    hn::Store(w, d, weight + i);
  }
}

}  // namespace
}  // namespace brume::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume {

HWY_EXPORT(LightCosines);
HWY_EXPORT(ProductWeights);

void light_cosines(const float* t, int n, const ProductTerms& terms, float* cosine) {
  HWY_DYNAMIC_DISPATCH(LightCosines)(t, n, terms, cosine);
}

void product_weights(const float* t, const float* p, const float* phase, int n, const ProductTerms& terms,
                     float* weight, float* angle) {
  HWY_DYNAMIC_DISPATCH(ProductWeights)(t, p, phase, n, terms, weight, angle);
}

}  // namespace brume
#endif  // HWY_ONCE
