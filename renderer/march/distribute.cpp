#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/march/distribute.cpp"
#include <hwy/foreach_target.h>  // compiles this file once per instruction set

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "renderer/march/distribute.h"

HWY_BEFORE_NAMESPACE();
namespace brume::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// length[i] = exp(-tau[i]) delta_i (1 - exp(-x)) / x with x = sigma_t[i] delta_i, for i in [0, n).
/// Arrays are padded to whole vectors; what is computed there is never read.
void AttenuatedLengths(int n, const float* HWY_RESTRICT t, const float* HWY_RESTRICT sigma_t,
                       const float* HWY_RESTRICT tau, float* HWY_RESTRICT length) {
  const hn::CappedTag<float, 16> d;
  const auto one = hn::Set(d, 1.0f);
  for (int i = 0; i < n; i += static_cast<int>(hn::Lanes(d))) {
    const auto delta = hn::Sub(hn::LoadU(d, t + i + 1), hn::Load(d, t + i));
    const auto x = hn::Mul(hn::Load(d, sigma_t + i), delta);
    const auto attenuation = hn::Exp(d, hn::Neg(hn::Load(d, tau + i)));
    // Below 1e-4 the series 1 - x/2 is exact in float; the quotient would be 0/0 at 0.
    const auto series = hn::NegMulAdd(hn::Set(d, 0.5f), x, one);
    const auto quotient = hn::Div(hn::Neg(hn::Expm1(d, hn::Neg(x))), x);
    const auto mean = hn::IfThenElse(hn::Lt(x, hn::Set(d, 1e-4f)), series, quotient);
    hn::Store(hn::Mul(hn::Mul(attenuation, delta), mean), d, length + i);
  }
}

}  // namespace brume::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume {

HWY_EXPORT(AttenuatedLengths);

namespace {

/// Running sums are kept in double: thousands of thin segments must add up to the optical depth within float rounding.
void accumulate_tau(int n, const float* t, const float* sigma_t, float* tau) {
  double sum = 0;
  tau[0] = 0;
  for (int i = 0; i < n; ++i) {
    sum += static_cast<double>(sigma_t[i] * (t[i + 1] - t[i]));
    tau[i + 1] = static_cast<float>(sum);
  }
}

}  // namespace

template <int C> void distribute(MarchRecord<C>& rec, Color throughput, Arena& arena) {
  const auto n = static_cast<std::size_t>(rec.n);
  rec.weight = channel_weights<C>(throughput);
  for (std::size_t c = 0; c < C; ++c) {
    rec.tau[c] = arena.alloc_span<float>(n + 1).data();
    rec.length[c] = arena.alloc_span<float>(n).data();
    accumulate_tau(rec.n, rec.t, rec.sigma_t[c], rec.tau[c]);
    HWY_DYNAMIC_DISPATCH(AttenuatedLengths)(rec.n, rec.t, rec.sigma_t[c], rec.tau[c], rec.length[c]);
  }
  float* cdf = arena.alloc_span<float>(n + 1).data();
  double sum = 0;
  cdf[0] = 0;
  for (std::size_t i = 0; i < n; ++i) {
    float p = 0;
    for (std::size_t c = 0; c < C; ++c) p += rec.weight.v[c] * rec.sigma_s[c][i] * rec.length[c][i];
    sum += static_cast<double>(p);
    cdf[i + 1] = static_cast<float>(sum);
  }
  rec.cdf = cdf;
}

template <int C> Color emitted_radiance(const MarchRecord<C>& rec) {
  Color sum;
  if (rec.emission[0] == nullptr) return sum;
  for (int c = 0; c < 3; ++c) {
    const float* length = rec.length[static_cast<std::size_t>(C == 1 ? 0 : c)];
    const float* emission = rec.emission[static_cast<std::size_t>(c)];
    double total = 0;
    for (int i = 0; i < rec.n; ++i) total += static_cast<double>(emission[i] * length[i]);
    sum[c] = static_cast<float>(total);
  }
  return sum;
}

template <int C> Spectrum<C> transmittance(const MarchRecord<C>& rec) {
  Spectrum<C> result;
  for (int c = 0; c < C; ++c) result[c] = rec.empty() ? 1.0f : std::exp(-rec.tau[static_cast<std::size_t>(c)][rec.n]);
  return result;
}

template void distribute<1>(MarchRecord<1>&, Color, Arena&);
template void distribute<3>(MarchRecord<3>&, Color, Arena&);
template Color emitted_radiance<1>(const MarchRecord<1>&);
template Color emitted_radiance<3>(const MarchRecord<3>&);
template Spectrum<1> transmittance<1>(const MarchRecord<1>&);
template Spectrum<3> transmittance<3>(const MarchRecord<3>&);

}  // namespace brume
#endif  // HWY_ONCE
