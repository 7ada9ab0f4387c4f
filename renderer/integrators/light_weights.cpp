#include "renderer/integrators/light_weights.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/integrators/light_weights.cpp"
#include <hwy/foreach_target.h>  // compiles this file once per instruction set

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace brume::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kWidestVector>;
using DI = hn::RebindToSigned<D>;
using V = hn::Vec<D>;

HWY_INLINE V load(const LaneArray<float>& values, int i) { return hn::Load(D(), values.v + i); }

/// Of samples drawn with density pdf when another technique, with as many samples, could have drawn them with density
/// other_pdf. Veach & Guibas 1995, "Optimally Combining Sampling Techniques", equations 14 and 16 (exponent 2). Divided
/// through by the larger pdf, so that no square overflows.
HWY_INLINE V weight_of(V pdf, V other_pdf, MisHeuristic heuristic) {
  const V one = hn::Set(D(), 1);
  const V zero = hn::Zero(D()), least = hn::Min(pdf, other_pdf);
  const V r = hn::IfThenElseZero(hn::Gt(least, zero), hn::Div(least, hn::Max(pdf, other_pdf)));
  const V smaller = heuristic == MisHeuristic::Power ? hn::Mul(r, r) : r;
  const V weight = hn::Div(hn::IfThenElse(hn::Ge(pdf, other_pdf), one, smaller), hn::Add(one, smaller));
  return hn::IfThenElseZero(hn::Gt(pdf, zero), weight);
}

template <int C>
HWY_INLINE void carry_to(LightWeights<C>& lanes, const LightLanes& lights, Color beta, MisHeuristic heuristic, int n) {
  const D d;
  for (int i = 0; i < n; i += static_cast<int>(hn::Lanes(d))) {
    const auto drawn = hn::Load(DI(), lanes.drawn.v + i);
    const auto is = [&](int bit) HWY_ATTR { return hn::RebindMask(d, hn::TestBit(drawn, hn::Set(DI(), bit))); };
    const auto about = is(LightWeights<C>::kAbout);
    const V equiangular = load(lanes.equiangular, i), unaimed = load(lanes.unaimed, i);
    const V directed = hn::Mul(unaimed, load(lanes.pdf_ratio, i));
    const V combined = weight_of(hn::IfThenElse(about, equiangular, directed),
                                 hn::IfThenElse(about, directed, equiangular), heuristic);
    const V weight = hn::IfThenElse(is(LightWeights<C>::kCombined), combined, hn::Set(d, 1));
    const V pdf = hn::IfThenElse(about, equiangular, unaimed);
    const V counts = hn::Div(hn::Mul(load(lanes.factor, i), weight), pdf);
    const V seen = hn::Mul(load(lights.seen(), i), load(lanes.phase, i));
    const auto is_drawn = hn::Gt(pdf, hn::Zero(d));
    for (int c = 0; c < 3; ++c) {
      const int channel = C == 1 ? 0 : c;
      const V scattered = hn::Mul(load(lanes.scattered[channel], i), load(lanes.left[channel], i));
      const V arrives = hn::Mul(load(lights.sent(c), i), seen);
      const V carried = hn::Mul(hn::Mul(hn::Mul(scattered, arrives), counts), hn::Set(d, beta[c]));
      hn::Store(hn::IfThenElseZero(is_drawn, carried), d, lanes.carried[c].v + i);
    }
  }
}

void Carry1(LightWeights<1>& lanes, const LightLanes& lights, Color beta, MisHeuristic heuristic, int n) {
  carry_to(lanes, lights, beta, heuristic, n);
}
void Carry3(LightWeights<3>& lanes, const LightLanes& lights, Color beta, MisHeuristic heuristic, int n) {
  carry_to(lanes, lights, beta, heuristic, n);
}

}  // namespace
}  // namespace brume::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume {

HWY_EXPORT(Carry1);
HWY_EXPORT(Carry3);

template <> void carry(LightWeights<1>& lanes, const LightLanes& lights, Color beta, MisHeuristic heuristic, int n) {
  HWY_DYNAMIC_DISPATCH(Carry1)(lanes, lights, beta, heuristic, n);
}
template <> void carry(LightWeights<3>& lanes, const LightLanes& lights, Color beta, MisHeuristic heuristic, int n) {
  HWY_DYNAMIC_DISPATCH(Carry3)(lanes, lights, beta, heuristic, n);
}

}  // namespace brume
#endif  // HWY_ONCE
