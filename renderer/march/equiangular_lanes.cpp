#include "renderer/march/equiangular_lanes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/march/equiangular_lanes.cpp"
#include <hwy/foreach_target.h>  // compiles this file once per instruction set

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "renderer/core/simd.h"

HWY_BEFORE_NAMESPACE();
namespace brume::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// As many lanes as the widest vectors have doubles: a vector of floats that was just written in two parts is late.
using DD = hn::CappedTag<double, kWidestVector / 2>;
using D = hn::Rebind<float, DD>;
using V = hn::Vec<D>;
using Arrays = EquiangularLanes::Arrays;

HWY_INLINE V set(float v) { return hn::Set(D(), v); }
HWY_INLINE V load(const LaneArray<float>& values, int i) { return hn::Load(D(), values.v + i); }
HWY_INLINE void store(V v, LaneArray<float>& out, int i) { hn::Store(v, D(), out.v + i); }

template <class F> HWY_INLINE void for_vectors(int n, const F& f) {
  for (int i = 0; i < n; i += static_cast<int>(hn::Lanes(D()))) f(i);
}

/// D^2 + a b
HWY_INLINE V squared(V distance, V a, V b) { return hn::MulAdd(distance, distance, hn::Mul(a, b)); }

/// A pivot and the ends of its span, seen from the foot.
struct Seen {
  V foot, distance, a, b;
};

/// foot_of(), in double like there: a pivot near a ray that begins far away would be lost.
HWY_INLINE Seen find_foot(const Arrays& lanes, const Ray& ray, int i) {
  const DD d;
  const D df;
  const auto from_float = [&](const LaneArray<float>& values) HWY_ATTR { return hn::PromoteTo(d, load(values, i)); };
  const auto all = [&](float v) HWY_ATTR { return hn::Set(d, static_cast<double>(v)); };
  const auto x = hn::Sub(from_float(lanes.pivot[0]), all(ray.origin.x)),
             y = hn::Sub(from_float(lanes.pivot[1]), all(ray.origin.y)),
             z = hn::Sub(from_float(lanes.pivot[2]), all(ray.origin.z));
  const auto dx = all(ray.direction.x), dy = all(ray.direction.y), dz = all(ray.direction.z);
  const auto foot = hn::MulAdd(x, dx, hn::MulAdd(y, dy, hn::Mul(z, dz)));
  const auto off_x = hn::NegMulAdd(dx, foot, x), off_y = hn::NegMulAdd(dy, foot, y), off_z = hn::NegMulAdd(dz, foot, z);
  const auto off = hn::Sqrt(hn::MulAdd(off_x, off_x, hn::MulAdd(off_y, off_y, hn::Mul(off_z, off_z))));
  const auto a = hn::Sub(from_float(lanes.begin), foot), b = hn::Sub(from_float(lanes.end), foot);
  const auto least = hn::Mul(hn::Set(d, kLeastPivotDistance), hn::Max(hn::Abs(a), hn::Abs(b)));
  return {hn::DemoteTo(df, foot), hn::DemoteTo(df, hn::Max(off, least)), hn::DemoteTo(df, a), hn::DemoteTo(df, b)};
}

void Measure(Arrays& lanes, const Ray& ray) {
  for_vectors(lanes.n, [&](int i) HWY_ATTR {
    const auto [foot, distance, a, b] = find_foot(lanes, ray, i);
    store(foot, lanes.foot, i), store(distance, lanes.distance, i), store(a, lanes.a, i), store(b, lanes.b, i);
    // atan2 of a y > 0
    const V length = hn::Sub(load(lanes.end, i), load(lanes.begin, i));
    const V y = hn::Mul(distance, length), x = squared(distance, a, b);
    const V acute = hn::Atan(D(), hn::Min(hn::Div(y, hn::Abs(x)), set(1e38f)));
    const V angle = hn::IfThenElse(hn::Lt(x, hn::Zero(D())), hn::Sub(set(kPi), acute), acute);
    store(hn::IfThenElseZero(hn::Gt(angle, set(1e-30f)), angle), lanes.angle, i);
  });
}

/// By Taylor's series; angles up to a right one are off by 6e-8 at most.
HWY_INLINE void sine_and_cosine(V angle, V& sine, V& cosine) {
  const V x2 = hn::Mul(angle, angle);
  V s = set(-1.0f / 39916800), c = set(1.0f / 479001600);
  c = hn::MulAdd(x2, c, set(-1.0f / 3628800));
  s = hn::MulAdd(x2, s, set(1.0f / 362880)), c = hn::MulAdd(x2, c, set(1.0f / 40320));
  s = hn::MulAdd(x2, s, set(-1.0f / 5040)), c = hn::MulAdd(x2, c, set(-1.0f / 720));
  s = hn::MulAdd(x2, s, set(1.0f / 120)), c = hn::MulAdd(x2, c, set(1.0f / 24));
  s = hn::MulAdd(x2, s, set(-1.0f / 6)), c = hn::MulAdd(x2, c, set(-0.5f));
  sine = hn::MulAdd(hn::Mul(angle, x2), s, angle), cosine = hn::MulAdd(x2, c, set(1));
}

void Sample(const Arrays& lanes, const LaneArray<float>& u, LaneArray<float>& t) {
  for_vectors(lanes.n, [&](int i) HWY_ATTR {
    const V begin = load(lanes.begin, i), end = load(lanes.end, i), from_begin = load(u, i);
    const auto is_nearer = hn::Lt(from_begin, set(0.5f));
    const V share = hn::IfThenElse(is_nearer, from_begin, hn::Sub(set(1), from_begin));
    const V distance = load(lanes.distance, i), angle = load(lanes.angle, i);
    const V e = hn::IfThenElse(is_nearer, load(lanes.a, i), hn::Neg(load(lanes.b, i)));
    V sine, cosine;
    sine_and_cosine(hn::Mul(angle, share), sine, cosine);
    const V equiangular =
        hn::Div(hn::Mul(sine, squared(distance, e, e)), hn::NegMulAdd(e, sine, hn::Mul(distance, cosine)));
    const V uniform = hn::Mul(share, hn::Sub(end, begin));
    const V away = hn::IfThenElse(hn::Gt(angle, hn::Zero(D())), equiangular, uniform);
    const V place = hn::IfThenElse(is_nearer, hn::Add(begin, away), hn::Sub(end, away));
    store(hn::Min(hn::Max(place, begin), end), t, i);
  });
}

void Pdf(const Arrays& lanes, const LaneArray<float>& begin, const LaneArray<float>& end, LaneArray<float>& pdf) {
  const V zero = hn::Zero(D()), one = set(1);
  for_vectors(lanes.n, [&](int i) HWY_ATTR {
    const V distance = load(lanes.distance, i), angle = load(lanes.angle, i), foot = load(lanes.foot, i);
    const V first = load(lanes.begin, i), last = load(lanes.end, i), from = load(begin, i), to = load(end, i);
    const V part_begin = hn::Max(from, first), part_end = hn::Min(to, last);
    const V a = hn::Sub(part_begin, foot), b = hn::Sub(part_end, foot), length = hn::Sub(to, from);
    const V r2 = squared(distance, a, b), part = hn::Sub(part_end, part_begin);
    // The angle of the part is atan x; by its series, for x is below 0.17.
    const V x = hn::Div(hn::Mul(distance, part), r2), x2 = hn::Mul(x, x);
    V series = hn::NegMulAdd(x2, set(1.0f / 7), set(1.0f / 5));
    series = hn::NegMulAdd(x2, series, set(1.0f / 3));
    series = hn::NegMulAdd(x2, series, one);
    const auto is_point = hn::Eq(from, to), is_uniform = hn::Eq(angle, zero);
    const V numerator = hn::IfThenElse(is_point, distance, hn::Mul(x, series));
    const V denominator = hn::Mul(angle, hn::IfThenElse(is_point, r2, length));
    const V uniform_part = hn::IfThenElse(is_point, one, hn::Div(part, length));
    const V density =
        hn::IfThenElse(is_uniform, hn::Div(uniform_part, hn::Sub(last, first)), hn::Div(numerator, denominator));
    // Nothing where the part is outside the span or the span is empty.
    const auto inside = hn::Or(hn::Lt(part_begin, part_end), hn::And(is_point, hn::Eq(part_begin, part_end)));
    store(hn::IfThenElseZero(hn::And(inside, hn::Lt(first, last)), density), pdf, i);
  });
}

}  // namespace
}  // namespace brume::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume {

HWY_EXPORT(Measure);
HWY_EXPORT(Sample);
HWY_EXPORT(Pdf);

void EquiangularLanes::aim(int lane, Vec3 pivot, Interval span) {
  for (int axis = 0; axis < 3; ++axis) lanes_.pivot[axis][lane] = pivot[axis];
  lanes_.begin[lane] = span.begin, lanes_.end[lane] = span.end;
}

void EquiangularLanes::measure(const Ray& ray, int n) {
  lanes_.n = n;
  HWY_DYNAMIC_DISPATCH(Measure)(lanes_, ray);
}
void EquiangularLanes::sample(const LaneArray<float>& u, LaneArray<float>& t) const {
  HWY_DYNAMIC_DISPATCH(Sample)(lanes_, u, t);
}
void EquiangularLanes::pdf(const LaneArray<float>& begin, const LaneArray<float>& end, LaneArray<float>& pdf) const {
  HWY_DYNAMIC_DISPATCH(Pdf)(lanes_, begin, end, pdf);
}

}  // namespace brume
#endif  // HWY_ONCE
