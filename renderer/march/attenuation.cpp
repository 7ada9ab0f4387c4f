#include "renderer/march/attenuation.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/march/attenuation.cpp"
#include <hwy/foreach_target.h>  // compiles this file once per instruction set

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace brume::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kWidestVector>;
using DI = hn::RebindToSigned<D>;
using V = hn::Vec<D>;

HWY_INLINE int lanes() { return static_cast<int>(hn::Lanes(D())); }
HWY_INLINE V set(float v) { return hn::Set(D(), v); }

/// Adds to every lane all lanes below it, by halves: the lanes of each right half get the last sum of the left half
/// beside it. Sums of the same beginning are built from the same parts, so they never descend and are the same where a
/// 0 was added, which those of Hillis & Steele are not. Sklansky 1960, "Conditional-Sum Addition Logic".
class Scan {
 public:
  HWY_INLINE Scan() : by1_(1), by2_(2), by4_(4), by8_(8), last_(hn::IndicesFromVec(D(), hn::Set(DI(), lanes() - 1))) {}

  HWY_INLINE V sums(V v) const {
    if (lanes() > 1) v = by1_.add(v);
    if (lanes() > 2) v = by2_.add(v);
    if (lanes() > 4) v = by4_.add(v);
    if (lanes() > 8) v = by8_.add(v);
    return v;
  }
  HWY_INLINE V last(V v) const { return hn::TableLookupLanes(v, last_); }

 private:
  using Lanes = decltype(hn::IndicesFromVec(D(), hn::Zero(DI())));

  class Halves {
   public:
    HWY_INLINE explicit Halves(int size) : left_end_(hn::IndicesFromVec(D(), left_end(size))) {
      is_right_ = hn::RebindMask(D(), hn::Ne(hn::And(hn::Iota(DI(), 0), hn::Set(DI(), size)), hn::Zero(DI())));
    }
    HWY_INLINE V add(V v) const {
      return hn::Add(v, hn::IfThenElseZero(is_right_, hn::TableLookupLanes(v, left_end_)));
    }

   private:
    static HWY_INLINE hn::Vec<DI> left_end(int size) {
      const auto begin = hn::AndNot(hn::Set(DI(), 2 * size - 1), hn::Iota(DI(), 0));
      return hn::And(hn::Add(begin, hn::Set(DI(), size - 1)), hn::Set(DI(), lanes() - 1));
    }
    Lanes left_end_;
    hn::Mask<D> is_right_;
  };

  const Halves by1_, by2_, by4_, by8_;
  const Lanes last_;
};

// A running sum goes on from vector to vector.

class ShortSum {
 public:
  HWY_INLINE ShortSum() : reached_(hn::Zero(D())) {}

  /// @param within  sums in the next vector.  @param last  the last of them, in all lanes.  @return the running sums
  HWY_INLINE V go_on(V within, V last) {
    const V before = reached_;
    reached_ = hn::Add(before, last);
    return hn::Add(before, within);
  }

 private:
  V reached_;  // all lanes
};

/// For so many vectors that their roundings would show: what each addition loses is carried along. Knuth 1969, "The Art
/// of Computer Programming", volume 2, section 4.2.2, theorem B.
class LongSum {
 public:
  HWY_INLINE LongSum() : reached_(hn::Zero(D())), lost_(hn::Zero(D())) {}

  HWY_INLINE V go_on(V within, V last) {
    const V before = reached_, sums = hn::Max(before, hn::Add(before, hn::Add(within, lost_)));
    const V more = hn::Add(last, lost_);
    reached_ = hn::Add(before, more);
    const V added = hn::Sub(reached_, before);
    lost_ = hn::Add(hn::Sub(before, hn::Sub(reached_, added)), hn::Sub(more, added));
    return sums;
  }

 private:
  V reached_, lost_;  // all lanes
};

/// Calls each(i, sums) with the running sums of value(i), one vector after the other.
template <class Value, class Each> HWY_INLINE void for_running_sums(int n, const Value& value, const Each& each) {
  constexpr int kShort = 512;
  const Scan scan;
  const auto add_up = [&](auto sum) HWY_ATTR {
    for (int i = 0; i < n; i += lanes()) {
      const V within = scan.sums(value(i));
      each(i, sum.go_on(within, scan.last(within)));
    }
  };
  n <= kShort ? add_up(ShortSum()) : add_up(LongSum());
}

/// exp(-x) and 1 - exp(-x) for x >= 0, relative errors below 2e-7 and 6e-7. With exp(-x) = 2^k exp(r), |r| <= ln(2) /
/// 2,
///   1 - exp(-x) = (1 - 2^k) - 2^k (exp(r) - 1),
/// where the last bracket is its series without the 1, and 1 - 2^k is exact. At most 2^k times the remainder of the
/// series is missing where k changes, from the side that keeps the one falling and the other climbing.
class Exponential {
 public:
  HWY_INLINE explicit Exponential(V x) {
    // Added to 1.5 * 2^23 a small number is rounded to an integer, which is then in the low bits.
    const V two23 = set(12582912.0f);
    x = hn::Min(x, set(kEnd));
    is_left_ = hn::Lt(x, set(kEnd));
    const V rounded = hn::NegMulAdd(x, set(1.44269504f), two23), k = hn::Sub(rounded, two23);
    V r = hn::NegMulAdd(k, set(0.693145752f), hn::Neg(x));
    r = hn::NegMulAdd(k, set(1.42860677e-6f), r);
    V series = set(1.0f / 720);
    series = hn::MulAdd(series, r, set(1.0f / 120));
    series = hn::MulAdd(series, r, set(1.0f / 24));
    series = hn::MulAdd(series, r, set(1.0f / 6));
    series = hn::MulAdd(series, r, set(0.5f));
    rest_ = hn::MulAdd(hn::Mul(r, r), series, r);
    const auto exponent = hn::ShiftLeft<23>(hn::BitCast(DI(), rounded));
    power_ = hn::BitCast(D(), hn::Add(exponent, hn::Set(DI(), 127 << 23)));
  }
  HWY_INLINE V transmittance() const { return hn::IfThenElseZero(is_left_, hn::MulAdd(power_, rest_, power_)); }
  HWY_INLINE V opacity() const { return hn::NegMulAdd(power_, rest_, hn::Sub(set(1), power_)); }

 private:
  static constexpr float kEnd = 87;  // 1.6e-38: nothing is left of the light
  V power_, rest_;                   // 2^k, exp(r) - 1
  hn::Mask<D> is_left_;
};

/// 1 / x to some roundings; for 0 whatever.
HWY_INLINE V reciprocal(V x) {
  const V guess = hn::ApproximateReciprocal(x);
  return hn::Mul(guess, hn::NegMulAdd(x, guess, set(2)));
}

/// Integral of exp(-sigma s) over segments of optical depths x, from what is left of the light at both ends.
HWY_INLINE V integral(V begin, V end, V x, V delta, V sigma) {
  const D d;
  // In thin segments, where begin - end would cancel, their mean times tanh(x/2) / (x/2) as its series, whose next term
  // is below 6e-8.
  const V xx = hn::Mul(x, x);
  V series = hn::MulAdd(xx, set(-17.0f / 20160), set(1.0f / 120));
  series = hn::MulAdd(xx, series, set(-1.0f / 12));
  const V mean = hn::Mul(hn::Mul(delta, set(0.5f)), hn::Add(begin, end));
  const V thin = hn::MulAdd(hn::Mul(mean, xx), series, mean);
  const auto is_thin = hn::Lt(x, set(0.4f));
  if (HWY_LIKELY(hn::AllTrue(d, is_thin))) return thin;
  return hn::IfThenElse(is_thin, thin, hn::Mul(hn::Sub(begin, end), reciprocal(sigma)));
}

/// Calls each(i, transmitted) for every vector of segments.
template <class Each>
HWY_INLINE void for_transmitted(const Segments& segments, const Coefficient& sigma_t, const float* transmittance,
                                const Coefficient& source, float factor, const Each& each) {
  const D d;
  const V sigma_scale = set(sigma_t.scale), source_scale = set(source.scale * factor);
  for (int i = 0; i < segments.n; i += lanes()) {
    const V delta = hn::Sub(hn::LoadU(d, segments.t + i + 1), hn::LoadU(d, segments.t + i));
    const V sigma = hn::Mul(sigma_scale, hn::Load(d, sigma_t.amount + i));
    const V begin = hn::LoadU(d, transmittance + i), end = hn::LoadU(d, transmittance + i + 1);
    const V length = integral(begin, end, hn::Mul(sigma, delta), delta, sigma);
    each(i, hn::Mul(hn::Mul(source_scale, hn::Load(d, source.amount + i)), length));
  }
}

void SumOpticalDepth(const Segments& segments, const Coefficient& sigma_t, float* tau) {
  const D d;
  tau[0] = 0;
  const auto put = [&](int i, V sums) HWY_ATTR { hn::StoreU(sums, d, tau + i + 1); };
  if (segments.step == 0) {
    const V scale = set(sigma_t.scale);
    for_running_sums(
        segments.n,
        [&](int i) HWY_ATTR {
          const V delta = hn::Sub(hn::LoadU(d, segments.t + i + 1), hn::LoadU(d, segments.t + i));
          return hn::Mul(hn::Mul(scale, hn::Load(d, sigma_t.amount + i)), delta);
        },
        put);
    return;
  }
  // The last one is shorter. Not mended afterwards: who reads a vector in which a number was just written waits.
  const int last = segments.n - 1;
  const float last_step = segments.t[last + 1] - segments.t[last];
  const V each = set(sigma_t.scale * segments.step);
  const auto is_last = hn::Eq(hn::Iota(d, 0), set(static_cast<float>(last % lanes())));
  const V each_at_end = hn::IfThenElse(is_last, set(sigma_t.scale * last_step), each);
  for_running_sums(
      segments.n,
      [&](int i)
          HWY_ATTR { return hn::Mul(i + lanes() < segments.n ? each : each_at_end, hn::Load(d, sigma_t.amount + i)); },
      put);
}

// Exponentials in a loop of their own: running sums are a long chain of operations, and with little else in their loop
// the processor works on several vectors' chains at once.

void Attenuate(const Segments& segments, const Coefficient& sigma_t, float* tau, float* transmittance) {
  SumOpticalDepth(segments, sigma_t, tau);
  transmittance[0] = 1;
  for (int i = 0; i < segments.n; i += lanes())
    hn::StoreU(Exponential(hn::LoadU(D(), tau + i + 1)).transmittance(), D(), transmittance + i + 1);
}

template <bool kAdd>
HWY_INLINE void attenuate_to(const Segments& segments, const Coefficient& sigma_t, float albedo, float* tau,
                             float* transmittance, float* cdf) {
  const D d;
  SumOpticalDepth(segments, sigma_t, tau);
  const V scatters = set(albedo);
  transmittance[0] = 1;
  if (!kAdd) cdf[0] = 0;
  for (int i = 0; i < segments.n; i += lanes()) {
    const Exponential exponential(hn::LoadU(d, tau + i + 1));
    hn::StoreU(exponential.transmittance(), d, transmittance + i + 1);
    const V opacity = exponential.opacity();
    hn::StoreU(kAdd ? hn::MulAdd(scatters, opacity, hn::LoadU(d, cdf + i + 1)) : hn::Mul(scatters, opacity), d,
               cdf + i + 1);
  }
}

void AttenuateAndSet(const Segments& segments, const Coefficient& sigma_t, float albedo, float* tau,
                     float* transmittance, float* cdf) {
  attenuate_to<false>(segments, sigma_t, albedo, tau, transmittance, cdf);
}

void AttenuateAndAdd(const Segments& segments, const Coefficient& sigma_t, float albedo, float* tau,
                     float* transmittance, float* cdf) {
  attenuate_to<true>(segments, sigma_t, albedo, tau, transmittance, cdf);
}

void AddTransmitted(const Segments& segments, const Coefficient& sigma_t, const float* transmittance,
                    const Coefficient& source, float factor, float* out) {
  for_transmitted(segments, sigma_t, transmittance, source, factor, [&](int i, V transmitted) HWY_ATTR {
    hn::Store(hn::Add(hn::Load(D(), out + i), transmitted), D(), out + i);
  });
}

float SumTransmitted(const Segments& segments, const Coefficient& sigma_t, const float* transmittance,
                     const Coefficient& source) {
  const D d;
  V sum = hn::Zero(d);
  for_transmitted(segments, sigma_t, transmittance, source, 1, [&](int i, V transmitted) HWY_ATTR {
    sum = hn::Add(sum, hn::IfThenElseZero(hn::FirstN(d, static_cast<std::size_t>(segments.n - i)), transmitted));
  });
  return hn::GetLane(hn::SumOfLanes(d, sum));
}

void RunningSum(const float* p, int n, float* cdf) {
  cdf[0] = 0;
  for_running_sums(
      n, [&](int i) HWY_ATTR { return hn::Load(D(), p + i); },
      [&](int i, V sums) HWY_ATTR { hn::StoreU(sums, D(), cdf + i + 1); });
}

void ExpMinus(float* values, int n) {
  const D d;
  for (int i = 0; i < n; i += lanes()) {
    const auto some = hn::FirstN(d, static_cast<std::size_t>(n - i));
    hn::BlendedStore(Exponential(hn::MaskedLoad(some, d, values + i)).transmittance(), some, d, values + i);
  }
}

}  // namespace
}  // namespace brume::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume {

HWY_EXPORT(Attenuate);
HWY_EXPORT(AttenuateAndSet);
HWY_EXPORT(AttenuateAndAdd);
HWY_EXPORT(AddTransmitted);
HWY_EXPORT(SumTransmitted);
HWY_EXPORT(RunningSum);
HWY_EXPORT(ExpMinus);

void attenuate(const Segments& segments, const Coefficient& sigma_t, float* tau, float* transmittance) {
  HWY_DYNAMIC_DISPATCH(Attenuate)(segments, sigma_t, tau, transmittance);
}
void attenuate(const Segments& segments, const Coefficient& sigma_t, float albedo, float* tau, float* transmittance,
               float* cdf) {
  HWY_DYNAMIC_DISPATCH(AttenuateAndSet)(segments, sigma_t, albedo, tau, transmittance, cdf);
}
void attenuate_and_add(const Segments& segments, const Coefficient& sigma_t, float albedo, float* tau,
                       float* transmittance, float* cdf) {
  HWY_DYNAMIC_DISPATCH(AttenuateAndAdd)(segments, sigma_t, albedo, tau, transmittance, cdf);
}
void add_transmitted(const Segments& segments, const Coefficient& sigma_t, const float* transmittance,
                     const Coefficient& source, float factor, float* out) {
  HWY_DYNAMIC_DISPATCH(AddTransmitted)(segments, sigma_t, transmittance, source, factor, out);
}
float sum_transmitted(const Segments& segments, const Coefficient& sigma_t, const float* transmittance,
                      const Coefficient& source) {
  return HWY_DYNAMIC_DISPATCH(SumTransmitted)(segments, sigma_t, transmittance, source);
}
void running_sum(const float* p, int n, float* cdf) { HWY_DYNAMIC_DISPATCH(RunningSum)(p, n, cdf); }
void exp_minus(float* values, int n) { HWY_DYNAMIC_DISPATCH(ExpMinus)(values, n); }

}  // namespace brume
#endif  // HWY_ONCE
