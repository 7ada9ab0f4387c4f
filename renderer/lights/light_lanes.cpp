#include "renderer/lights/light_lanes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/lights/light_lanes.cpp"
#include <hwy/foreach_target.h>  // compiles this file once per instruction set

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace brume::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kWidestVector>;
using DI = hn::RebindToSigned<D>;
using V = hn::Vec<D>;

HWY_INLINE V set(float v) { return hn::Set(D(), v); }

struct V3 {
  V x, y, z;
};
HWY_INLINE V load(const LaneArray<float>& a, int i) { return hn::Load(D(), a.v + i); }
HWY_INLINE V3 load(const LaneArray<float> a[3], int i) { return {load(a[0], i), load(a[1], i), load(a[2], i)}; }
HWY_INLINE V3 set(Vec3 v) { return {set(v.x), set(v.y), set(v.z)}; }
HWY_INLINE void store(V v, LaneArray<float>& a, int i) { hn::Store(v, D(), a.v + i); }
HWY_INLINE void store(V3 v, LaneArray<float> a[3], int i) {
  store(v.x, a[0], i), store(v.y, a[1], i), store(v.z, a[2], i);
}
HWY_INLINE V dot(V3 a, V3 b) { return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z))); }

void Look(LightLanes::Arrays& lanes, const Ray& ray, const LaneArray<float>& t, int n) {
  const D d;
  const V zero = hn::Zero(d), one = set(1);
  const V3 origin = set(ray.origin), direction = set(ray.direction);
  for (int i = 0; i < n; i += static_cast<int>(hn::Lanes(d))) {
    const auto kind = hn::Load(DI(), lanes.kind.v + i);
    const auto is = [&](int bit) HWY_ATTR { return hn::RebindMask(d, hn::TestBit(kind, hn::Set(DI(), bit))); };
    const V at = load(t, i);
    // Not fused, as all places on rays.
    const V3 x{hn::Add(hn::Mul(direction.x, at), origin.x), hn::Add(hn::Mul(direction.y, at), origin.y),
               hn::Add(hn::Mul(direction.z, at), origin.z)};
    const V3 place = load(lanes.place, i);
    const V3 to_light{hn::Sub(place.x, x.x), hn::Sub(place.y, x.y), hn::Sub(place.z, x.z)};
    const V r = hn::Sqrt(dot(to_light, to_light));
    const V inverse = hn::IfThenElseZero(hn::Gt(r, set(kAtTheLight)), hn::Div(one, r));  // no direction at the light
    const auto is_distant = is(LightLanes::kDistant);
    const auto towards = [&](V to, V far) HWY_ATTR { return hn::IfThenElse(is_distant, far, hn::Mul(to, inverse)); };
    const V3 wi{towards(to_light.x, place.x), towards(to_light.y, place.y), towards(to_light.z, place.z)};
    // falloff(cos) / r^2
    V c = hn::Neg(dot(wi, load(lanes.normal, i)));
    c = hn::IfThenElse(is(LightLanes::kTwoSided), hn::Abs(c), c);
    V s = hn::Mul(hn::Sub(c, load(lanes.begin, i)), load(lanes.slope, i));
    s = hn::Min(hn::Max(s, zero), one);
    s = hn::IfThenElse(is(LightLanes::kSmooth), hn::Mul(hn::Mul(s, s), hn::NegMulAdd(set(2), s, set(3))), s);
    const V seen = hn::Mul(s, hn::Mul(inverse, inverse));
    store(x, lanes.x, i);
    store(wi, lanes.wi, i);
    store(hn::IfThenElse(is_distant, hn::Inf(d), r), lanes.distance, i);
    store(hn::IfThenElse(is_distant, one, seen), lanes.seen, i);
    store(dot(direction, wi), lanes.cosine, i);
  }
}

}  // namespace
}  // namespace brume::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume {

HWY_EXPORT(Look);

void LightLanes::set(int lane, const LightPoint& point) {
  const bool finite = point.kind == LightPoint::Kind::Finite;
  const Vec3& place = finite ? point.position : point.direction;
  for (int axis = 0; axis < 3; ++axis) {
    arrays_.place[axis][lane] = place[axis];
    arrays_.normal[axis][lane] = point.normal[axis];
    arrays_.sent[axis][lane] = point.sent[axis];
  }
  arrays_.begin[lane] = point.falloff.begin, arrays_.slope[lane] = point.falloff.slope;
  arrays_.kind[lane] =
      (finite ? 0 : kDistant) | (point.falloff.two_sided ? kTwoSided : 0) | (point.falloff.smooth ? kSmooth : 0);
}

void LightLanes::look(const Ray& ray, const LaneArray<float>& t, int n) {
  HWY_DYNAMIC_DISPATCH(Look)(arrays_, ray, t, n);
}

void LightLanes::replace(int lane, Vec3 wi, float distance, Color irradiance) {
  for (int axis = 0; axis < 3; ++axis) arrays_.wi[axis][lane] = wi[axis], arrays_.sent[axis][lane] = irradiance[axis];
  arrays_.distance[lane] = distance, arrays_.seen[lane] = 1;
}

}  // namespace brume
#endif  // HWY_ONCE
