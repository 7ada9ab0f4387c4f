#include "renderer/march/step_loops.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/march/step_loops.cpp"
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

/// The lanes of a vector as positions in an array.
HWY_INLINE V iota() { return hn::Iota(D(), 0); }

struct Line {
  V ox, oy, oz, dx, dy, dz;
  HWY_INLINE explicit Line(const Ray& ray)
      : ox(hn::Set(D(), ray.origin.x)),
        oy(hn::Set(D(), ray.origin.y)),
        oz(hn::Set(D(), ray.origin.z)),
        dx(hn::Set(D(), ray.direction.x)),
        dy(hn::Set(D(), ray.direction.y)),
        dz(hn::Set(D(), ray.direction.z)) {}

  HWY_INLINE void store(V t, float* x, float* y, float* z) const {
    const D d;
    hn::StoreU(hn::MulAdd(dx, t, ox), d, x);
    hn::StoreU(hn::MulAdd(dy, t, oy), d, y);
    hn::StoreU(hn::MulAdd(dz, t, oz), d, z);
  }
};

void WriteSteps(const Ray& ray, const StepRow& row, float* t, float* x, float* y, float* z) {
  const D d;
  const Line line(ray);
  const V begin = hn::Set(d, row.begin), step = hn::Set(d, row.step), inside = hn::Set(d, row.offset * row.step);
  for (int i = 0; i < row.n; i += lanes()) {
    const V number = hn::Add(iota(), hn::Set(d, static_cast<float>(i)));
    const V edge = hn::MulAdd(number, step, begin);
    hn::StoreU(edge, d, t + i);
    line.store(hn::Add(edge, inside), x + i, y + i, z + i);
  }
}

void WriteEdges(const StepRow& row, float* t) {
  const D d;
  const V begin = hn::Set(d, row.begin), step = hn::Set(d, row.step);
  for (int i = 0; i < row.n; i += lanes())
    hn::StoreU(hn::MulAdd(hn::Add(iota(), hn::Set(d, static_cast<float>(i))), step, begin), d, t + i);
}

float Sum(const float* values, int n) {
  const D d;
  V total = hn::Zero(d);
  int i = 0;
  for (; i + lanes() <= n; i += lanes()) total = hn::Add(total, hn::LoadU(d, values + i));
  float all = hn::GetLane(hn::SumOfLanes(d, total));
  for (; i < n; ++i) all += values[i];
  return all;
}

/// Calls f(i) -> V for whole vectors and stores them; of the last one, what is left.
template <class F> HWY_INLINE void store_each(int n, float* out, const F& f) {
  const D d;
  int i = 0;
  for (; i + lanes() <= n; i += lanes()) hn::StoreU(f(i), d, out + i);
  if (i < n) hn::BlendedStore(f(i), hn::FirstN(d, static_cast<std::size_t>(n - i)), d, out + i);
}

void SetScaled(const float* values, float factor, int n, float* out) {
  const V all = hn::Set(D(), factor);
  store_each(n, out, [&](int i) HWY_ATTR { return hn::Mul(all, hn::LoadU(D(), values + i)); });
}

void AddScaled(const float* values, float factor, int n, float* out) {
  const V all = hn::Set(D(), factor);
  store_each(n, out,
             [&](int i) HWY_ATTR { return hn::MulAdd(all, hn::LoadU(D(), values + i), hn::LoadU(D(), out + i)); });
}

/// Moves lanes up: lane i gets lane i - by, the lowest ones `below`.
class Shift {
 public:
  HWY_INLINE explicit Shift(int by) : indices_(hn::IndicesFromVec(D(), hn::Max(from(by), hn::Zero(DI())))) {
    low_ = hn::RebindMask(D(), hn::Lt(from(by), hn::Zero(DI())));
  }
  HWY_INLINE V operator()(V v, V below) const { return hn::IfThenElse(low_, below, hn::TableLookupLanes(v, indices_)); }
  HWY_INLINE V operator()(V v) const { return hn::IfThenZeroElse(low_, hn::TableLookupLanes(v, indices_)); }

 private:
  static HWY_INLINE hn::Vec<DI> from(int by) { return hn::Sub(hn::Iota(DI(), 0), hn::Set(DI(), by)); }
  decltype(hn::IndicesFromVec(D(), hn::Zero(DI()))) indices_;
  hn::Mask<D> low_;
};

/// Combines every lane with all lanes below it. Hillis & Steele 1986, "Data Parallel Algorithms".
class Scan {
 public:
  HWY_INLINE Scan() : by1(1), by2(2), by4(4), by8(8), last_(hn::IndicesFromVec(D(), hn::Set(DI(), lanes() - 1))) {}

  HWY_INLINE V sums(V v) const {
    if (lanes() > 1) v = hn::Add(v, by1(v));
    if (lanes() > 2) v = hn::Add(v, by2(v));
    if (lanes() > 4) v = hn::Add(v, by4(v));
    if (lanes() > 8) v = hn::Add(v, by8(v));
    return v;
  }
  /// Of values that are not negative.
  HWY_INLINE V maxima(V v) const {
    if (lanes() > 1) v = hn::Max(v, by1(v));
    if (lanes() > 2) v = hn::Max(v, by2(v));
    if (lanes() > 4) v = hn::Max(v, by4(v));
    if (lanes() > 8) v = hn::Max(v, by8(v));
    return v;
  }
  HWY_INLINE V last(V v) const { return hn::TableLookupLanes(v, last_); }

  const Shift by1;

 private:
  const Shift by2, by4, by8;
  const decltype(hn::IndicesFromVec(D(), hn::Zero(DI()))) last_;
};

/// A running sum over vectors.
class ShortCarry {
 public:
  HWY_INLINE ShortCarry() : sum_(hn::Zero(D())) {}
  HWY_INLINE V plus(V within) const { return hn::Add(sum_, within); }
  HWY_INLINE void add(V last) { sum_ = hn::Add(sum_, last); }

 private:
  V sum_;  // all lanes
};

/// The same in double, for so many vectors that their roundings would show; added to sums inside a vector as two
/// floats.
class LongCarry {
 public:
  HWY_INLINE V plus(V within) const {
    const float high = static_cast<float>(sum_), low = static_cast<float>(sum_ - static_cast<double>(high));
    return hn::Add(hn::Set(D(), high), hn::Add(within, hn::Set(D(), low)));
  }
  HWY_INLINE void add(V last) { sum_ += static_cast<double>(hn::GetLane(last)); }

 private:
  double sum_ = 0;
};

constexpr int kShort = 512;  // steps

/// exp(-x) for x >= 0, relative error below 2e-7: 2^k exp(r), the second as its series.
HWY_INLINE V exp_minus(V x) {
  const D d;
  const V k = hn::Round(hn::Mul(x, hn::Set(d, -1.44269504f)));
  V r = hn::NegMulAdd(k, hn::Set(d, 0.693145752f), hn::Neg(x));
  r = hn::NegMulAdd(k, hn::Set(d, 1.42860677e-6f), r);
  V p = hn::Set(d, 1.0f / 720);
  p = hn::MulAdd(p, r, hn::Set(d, 1.0f / 120));
  p = hn::MulAdd(p, r, hn::Set(d, 1.0f / 24));
  p = hn::MulAdd(p, r, hn::Set(d, 1.0f / 6));
  p = hn::MulAdd(p, r, hn::Set(d, 0.5f));
  p = hn::MulAdd(p, r, hn::Set(d, 1.0f));
  p = hn::MulAdd(p, r, hn::Set(d, 1.0f));
  const auto power = hn::BitCast(d, hn::ShiftLeft<23>(hn::Add(hn::ConvertTo(DI(), k), hn::Set(DI(), 127))));
  return hn::IfThenElseZero(hn::Lt(x, hn::Set(d, 87.0f)), hn::Mul(p, power));
}

/// 1 / x to some roundings; for 0 whatever.
HWY_INLINE V reciprocal(V x) {
  const V guess = hn::ApproximateReciprocal(x);
  return hn::Mul(guess, hn::NegMulAdd(x, guess, hn::Set(D(), 2.0f)));
}

/// Integral of exp(-sigma s) over segments of optical depths x, from what is left of the light at both ends.
HWY_INLINE V integral(V begin, V end, V x, V delta, V sigma) {
  const D d;
  // In thin segments, where begin - end would cancel, their mean times tanh(x/2) / (x/2) as its series, whose next term
  // is below 6e-8.
  const V xx = hn::Mul(x, x);
  V series = hn::MulAdd(xx, hn::Set(d, -17.0f / 20160), hn::Set(d, 1.0f / 120));
  series = hn::MulAdd(xx, series, hn::Set(d, -1.0f / 12));
  const V mean = hn::Mul(hn::Mul(delta, hn::Set(d, 0.5f)), hn::Add(begin, end));
  const V thin = hn::MulAdd(hn::Mul(mean, xx), series, mean);
  const auto is_thin = hn::Lt(x, hn::Set(d, 0.4f));
  if (HWY_LIKELY(hn::AllTrue(d, is_thin))) return thin;
  return hn::IfThenElse(is_thin, thin, hn::Mul(hn::Sub(begin, end), reciprocal(sigma)));
}

// One loop for each step and not one for all: a running sum is a long chain of operations, and with little else in the
// loop the processor works on several vectors' chains at once.

template <class Carry> HWY_INLINE void sum_optical_depth(const float* t, const float* sigma_t, int n, float* tau) {
  const D d;
  const Scan scan;
  Carry before;
  tau[0] = 0;
  for (int i = 0; i < n; i += lanes()) {
    const V delta = hn::Sub(hn::LoadU(d, t + i + 1), hn::LoadU(d, t + i));
    const V within = scan.sums(hn::Mul(hn::Load(d, sigma_t + i), delta));
    hn::StoreU(before.plus(within), d, tau + i + 1);
    before.add(scan.last(within));
  }
}

HWY_INLINE void attenuate_edges(const float* tau, int n, float* transmittance) {
  const D d;
  transmittance[0] = 1;
  for (int i = 0; i < n; i += lanes()) hn::StoreU(exp_minus(hn::LoadU(d, tau + i + 1)), d, transmittance + i + 1);
}

/// Calls each(i, length) for every vector of segments.
template <class Each>
HWY_INLINE void integrate(const float* t, const float* sigma_t, int n, const Attenuation& out, const Each& each) {
  const D d;
  const float* const transmittance = out.transmittance;
  float* const lengths = out.length;
  for (int i = 0; i < n; i += lanes()) {
    const V delta = hn::Sub(hn::LoadU(d, t + i + 1), hn::LoadU(d, t + i)), sigma = hn::Load(d, sigma_t + i);
    const V begin = hn::LoadU(d, transmittance + i), end = hn::LoadU(d, transmittance + i + 1);
    const V length = integral(begin, end, hn::Mul(sigma, delta), delta, sigma);
    hn::Store(length, d, lengths + i);
    each(i, length);
  }
}

template <class Each>
HWY_INLINE void attenuate_with(const float* t, const float* sigma_t, int n, const Attenuation& out, const Each& each) {
  n <= kShort ? sum_optical_depth<ShortCarry>(t, sigma_t, n, out.tau)
              : sum_optical_depth<LongCarry>(t, sigma_t, n, out.tau);
  attenuate_edges(out.tau, n, out.transmittance);
  integrate(t, sigma_t, n, out, each);
}

template <class Carry> HWY_INLINE void sum_up(const float* p, int n, float* cdf) {
  const D d;
  const Scan scan;
  Carry before;
  V reached = hn::Zero(d);  // all lanes
  cdf[0] = 0;
  for (int i = 0; i < n; i += lanes()) {
    const V v = hn::Load(d, p + i);
    const V within = scan.sums(v);
    V sums = before.plus(within);
    before.add(scan.last(within));
    // Sums in a vector are of different groupings, which may differ by rounding: whatever p does, the CDF climbs, and
    // only where there is something to add.
    const V below = scan.by1(sums, reached);
    const auto flat = hn::Eq(v, hn::Zero(d));
    if (HWY_UNLIKELY(!hn::AllFalse(d, hn::Or(hn::Lt(sums, below), hn::And(flat, hn::Ne(sums, below))))))
      sums = hn::Max(reached, scan.maxima(hn::IfThenZeroElse(flat, sums)));
    reached = scan.last(sums);
    hn::StoreU(sums, d, cdf + i + 1);
  }
}

void ExpMinus(float* values, int n) {
  const D d;
  for (int i = 0; i < n; i += lanes()) {
    const auto some = hn::FirstN(d, static_cast<std::size_t>(n - i));
    hn::BlendedStore(exp_minus(hn::MaskedLoad(some, d, values + i)), some, d, values + i);
  }
}

void Attenuate(const float* t, const float* sigma_t, int n, const Attenuation& out) {
  attenuate_with(t, sigma_t, n, out, [](int, V) HWY_ATTR {});
}

void AttenuateAndSum(const float* t, const float* sigma_t, const float* sigma_s, int n, const Attenuation& out,
                     float* p, float* cdf) {
  attenuate_with(t, sigma_t, n, out,
                 [&](int i, V length) HWY_ATTR { hn::Store(hn::Mul(hn::Load(D(), sigma_s + i), length), D(), p + i); });
  n <= kShort ? sum_up<ShortCarry>(p, n, cdf) : sum_up<LongCarry>(p, n, cdf);
}

void RunningSum(const float* p, int n, float* cdf) {
  n <= kShort ? sum_up<ShortCarry>(p, n, cdf) : sum_up<LongCarry>(p, n, cdf);
}

}  // namespace
}  // namespace brume::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume {

HWY_EXPORT(WriteSteps);
HWY_EXPORT(WriteEdges);
HWY_EXPORT(Sum);
HWY_EXPORT(SetScaled);
HWY_EXPORT(AddScaled);
HWY_EXPORT(ExpMinus);
HWY_EXPORT(Attenuate);
HWY_EXPORT(AttenuateAndSum);
HWY_EXPORT(RunningSum);

void write_edges(const StepRow& row, float* t) { HWY_DYNAMIC_DISPATCH(WriteEdges)(row, t); }
void write_steps(const Ray& ray, const StepRow& row, float* t, float* x, float* y, float* z) {
  HWY_DYNAMIC_DISPATCH(WriteSteps)(ray, row, t, x, y, z);
}
float sum(const float* values, int n) { return HWY_DYNAMIC_DISPATCH(Sum)(values, n); }
void set_scaled(const float* values, float factor, int n, float* out) {
  HWY_DYNAMIC_DISPATCH(SetScaled)(values, factor, n, out);
}
void add_scaled(const float* values, float factor, int n, float* out) {
  HWY_DYNAMIC_DISPATCH(AddScaled)(values, factor, n, out);
}
void exp_minus(float* values, int n) { HWY_DYNAMIC_DISPATCH(ExpMinus)(values, n); }
void attenuate(const float* t, const float* sigma_t, int n, const Attenuation& out) {
  HWY_DYNAMIC_DISPATCH(Attenuate)(t, sigma_t, n, out);
}
void attenuate(const float* t, const float* sigma_t, const float* sigma_s, int n, const Attenuation& out, float* p,
               float* cdf) {
  HWY_DYNAMIC_DISPATCH(AttenuateAndSum)(t, sigma_t, sigma_s, n, out, p, cdf);
}
void running_sum(const float* p, int n, float* cdf) { HWY_DYNAMIC_DISPATCH(RunningSum)(p, n, cdf); }

}  // namespace brume
#endif  // HWY_ONCE
