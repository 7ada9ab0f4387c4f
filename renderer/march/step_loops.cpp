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
using V = hn::Vec<D>;

HWY_INLINE int lanes() { return static_cast<int>(hn::Lanes(D())); }

/// The lanes of a vector as positions in an array.
HWY_INLINE V iota() { return hn::Iota(D(), 0); }

// Places are not fused from products and sums: they have the same bits at every level, or rays that graze a medium
// would meet another one.

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
    hn::StoreU(hn::Add(hn::Mul(dx, t), ox), d, x);
    hn::StoreU(hn::Add(hn::Mul(dy, t), oy), d, y);
    hn::StoreU(hn::Add(hn::Mul(dz, t), oz), d, z);
  }
};

void WriteSteps(const Ray& ray, const StepRow& row, float* t, float* x, float* y, float* z) {
  const D d;
  const Line line(ray);
  const V begin = hn::Set(d, row.begin), step = hn::Set(d, row.step), offset = hn::Set(d, row.offset);
  const V end = hn::Set(d, row.end), all = hn::Mul(offset, step), last = hn::Set(d, static_cast<float>(row.n - 1));
  const V each = hn::Set(d, static_cast<float>(lanes()));
  V number = iota();
  for (int i = 0; i < row.n; i += lanes()) {
    const V edge = hn::Add(hn::Mul(number, step), begin);
    hn::StoreU(edge, d, t + i);
    const V inside = hn::IfThenElse(hn::Lt(number, last), all, hn::Mul(offset, hn::Sub(end, edge)));
    number = hn::Add(number, each);
    line.store(hn::Add(edge, inside), x + i, y + i, z + i);
  }
}

void WriteEdges(const StepRow& row, float* t) {
  const D d;
  const V begin = hn::Set(d, row.begin), step = hn::Set(d, row.step);
  for (int i = 0; i < row.n; i += lanes())
    hn::StoreU(hn::Add(hn::Mul(hn::Add(iota(), hn::Set(d, static_cast<float>(i))), step), begin), d, t + i);
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

}  // namespace brume
#endif  // HWY_ONCE
