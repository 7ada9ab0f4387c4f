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

using D = hn::CappedTag<float, kWidestVector>;
using V = hn::Vec<D>;
using Arrays = EquiangularLanes::Arrays;

HWY_INLINE V set(float v) { return hn::Set(D(), v); }
HWY_INLINE V load(const float* values, int i) { return hn::Load(D(), values + i); }

template <class F> HWY_INLINE void for_vectors(int n, const F& f) {
  for (int i = 0; i < n; i += static_cast<int>(hn::Lanes(D()))) f(i);
}

/// foot_of(), in double like there: a pivot near a ray that begins far away would be lost.
void FindFeet(const Arrays& lanes, const Ray& ray) {
  const hn::CappedTag<double, kWidestVector / 2> d;
  const hn::Rebind<float, decltype(d)> df;
  for (int i = 0; i < lanes.n; i += static_cast<int>(hn::Lanes(d))) {
    const auto from_float = [&](const float* values) HWY_ATTR { return hn::PromoteTo(d, hn::Load(df, values + i)); };
    const auto put = [&](auto v, float* values) HWY_ATTR { hn::Store(hn::DemoteTo(df, v), df, values + i); };
    const auto all = [&](float v) HWY_ATTR { return hn::Set(d, static_cast<double>(v)); };
    const auto x = hn::Sub(from_float(lanes.pivot[0]), all(ray.origin.x)),
               y = hn::Sub(from_float(lanes.pivot[1]), all(ray.origin.y)),
               z = hn::Sub(from_float(lanes.pivot[2]), all(ray.origin.z));
    const auto dx = all(ray.direction.x), dy = all(ray.direction.y), dz = all(ray.direction.z);
    const auto foot = hn::MulAdd(x, dx, hn::MulAdd(y, dy, hn::Mul(z, dz)));
    const auto off_x = hn::NegMulAdd(dx, foot, x), off_y = hn::NegMulAdd(dy, foot, y),
               off_z = hn::NegMulAdd(dz, foot, z);
    const auto off = hn::Sqrt(hn::MulAdd(off_x, off_x, hn::MulAdd(off_y, off_y, hn::Mul(off_z, off_z))));
    const auto a = hn::Sub(from_float(lanes.begin), foot), b = hn::Sub(from_float(lanes.end), foot);
    const auto least = hn::Mul(hn::Set(d, kLeastPivotDistance), hn::Max(hn::Abs(a), hn::Abs(b)));
    put(foot, lanes.foot), put(hn::Max(off, least), lanes.distance), put(a, lanes.a), put(b, lanes.b);
  }
}

/// D^2 + a b
HWY_INLINE V squared(V distance, V a, V b) { return hn::MulAdd(distance, distance, hn::Mul(a, b)); }

void Measure(const Arrays& lanes, const Ray& ray) {
  FindFeet(lanes, ray);
  for_vectors(lanes.n, [&](int i) HWY_ATTR {
    // atan2 of a y > 0
    const V distance = load(lanes.distance, i), a = load(lanes.a, i), b = load(lanes.b, i);
    const V length = hn::Sub(load(lanes.end, i), load(lanes.begin, i));
    const V y = hn::Mul(distance, length), x = squared(distance, a, b);
    const V acute = hn::Atan(D(), hn::Min(hn::Div(y, hn::Abs(x)), set(1e38f)));
    const V angle = hn::IfThenElse(hn::Lt(x, hn::Zero(D())), hn::Sub(set(kPi), acute), acute);
    hn::Store(hn::IfThenElseZero(hn::Gt(angle, set(1e-30f)), angle), D(), lanes.angle + i);
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

void Sample(const Arrays& lanes, const float* u, float* t) {
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
    hn::Store(hn::Min(hn::Max(place, begin), end), D(), t + i);
  });
}

void Pdf(const Arrays& lanes, const float* begin, const float* end, float* pdf) {
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
    hn::Store(hn::IfThenElseZero(hn::And(inside, hn::Lt(first, last)), density), D(), pdf + i);
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

EquiangularLanes::EquiangularLanes(int lanes, Arena& arena) : lanes_{} {
  lanes_.n = lanes;
  const std::size_t stride = whole_vectors(lanes);
  float* array = arena.alloc_span<float>(10 * stride).data();
  for (float** const a : {&lanes_.pivot[0], &lanes_.pivot[1], &lanes_.pivot[2], &lanes_.begin, &lanes_.end,
                          &lanes_.foot, &lanes_.distance, &lanes_.a, &lanes_.b, &lanes_.angle})
    *a = std::exchange(array, array + stride);
}

void EquiangularLanes::aim(int lane, Vec3 pivot, Interval span) {
  for (int axis = 0; axis < 3; ++axis) lanes_.pivot[axis][lane] = pivot[axis];
  lanes_.begin[lane] = span.begin, lanes_.end[lane] = span.end;
}

void EquiangularLanes::measure(const Ray& ray) { HWY_DYNAMIC_DISPATCH(Measure)(lanes_, ray); }
void EquiangularLanes::sample(const float* u, float* t) const { HWY_DYNAMIC_DISPATCH(Sample)(lanes_, u, t); }
void EquiangularLanes::pdf(const float* begin, const float* end, float* pdf) const {
  HWY_DYNAMIC_DISPATCH(Pdf)(lanes_, begin, end, pdf);
}

}  // namespace brume
#endif  // HWY_ONCE
