#include "renderer/march/shadow_rays.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/march/shadow_rays.cpp"
#include <hwy/foreach_target.h>  // compiles this file once per instruction set

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace brume::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kWidestVector>;
using V = hn::Vec<D>;

HWY_INLINE int lanes() { return static_cast<int>(hn::Lanes(D())); }

void ClipToBox(const ShadowRays& rays, const Affine& box_from_scene, Vec3 low, Vec3 high, float* from, float* to) {
  const D d;
  const V least = hn::Set(d, 1e-30f);
  for (int i = 0; i < rays.n; i += lanes()) {
    const V ox = hn::Load(d, rays.origin[0] + i), oy = hn::Load(d, rays.origin[1] + i),
            oz = hn::Load(d, rays.origin[2] + i);
    const V wx = hn::Load(d, rays.direction[0] + i), wy = hn::Load(d, rays.direction[1] + i),
            wz = hn::Load(d, rays.direction[2] + i);
    V begin = hn::Load(d, rays.begin + i), end = hn::Load(d, rays.end + i);
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 row = box_from_scene.row[axis];
      const V rx = hn::Set(d, row.x), ry = hn::Set(d, row.y), rz = hn::Set(d, row.z);
      const V o = hn::MulAdd(rx, ox, hn::MulAdd(ry, oy, hn::MulAdd(rz, oz, hn::Set(d, box_from_scene.offset[axis]))));
      V w = hn::MulAdd(rx, wx, hn::MulAdd(ry, wy, hn::Mul(rz, wz)));
      // Parallel to the faces the way to them is endless, one way or the other.
      w = hn::IfThenElse(hn::Lt(hn::Abs(w), least), least, w);
      const V inverse = hn::Div(hn::Set(d, 1.0f), w);
      const V a = hn::Mul(hn::Sub(hn::Set(d, low[axis]), o), inverse);
      const V b = hn::Mul(hn::Sub(hn::Set(d, high[axis]), o), inverse);
      begin = hn::Max(begin, hn::Min(a, b));
      end = hn::Min(end, hn::Max(a, b));
    }
    hn::Store(begin, d, from + i);
    hn::Store(end, d, to + i);
  }
}

void WritePoints(const ShadowRays& rays, std::span<const ShadowRow> rows, float* x, float* y, float* z) {
  const D d;
  const V iota = hn::Iota(d, 0), each = hn::Set(d, static_cast<float>(lanes()));
  for (const ShadowRow& row : rows) {
    const Ray ray = rays[row.ray];
    const V ox = hn::Set(d, ray.origin.x), oy = hn::Set(d, ray.origin.y), oz = hn::Set(d, ray.origin.z);
    const V wx = hn::Set(d, ray.direction.x), wy = hn::Set(d, ray.direction.y), wz = hn::Set(d, ray.direction.z);
    const V begin = hn::Set(d, row.begin), step = hn::Set(d, row.step);
    float* const px = x + row.first;
    float* const py = y + row.first;
    float* const pz = z + row.first;
    V number = iota;
    for (int i = 0; i < row.n; i += lanes()) {
      // Not fused, as in step_loops.cpp.
      const V t = hn::Add(hn::Mul(number, step), begin);
      number = hn::Add(number, each);
      hn::StoreU(hn::Add(hn::Mul(wx, t), ox), d, px + i);
      hn::StoreU(hn::Add(hn::Mul(wy, t), oy), d, py + i);
      hn::StoreU(hn::Add(hn::Mul(wz, t), oz), d, pz + i);
    }
    const Vec3 last = ray.at(row.last);
    px[row.n - 1] = last.x, py[row.n - 1] = last.y, pz[row.n - 1] = last.z;
  }
}

void AddAmounts(std::span<const ShadowRow> rows, const float* density, double* amounts) {
  const D d;
  for (const ShadowRow& row : rows) {
    const float* const values = density + row.first;
    V total = hn::Zero(d);
    int i = 0;
    for (; i + lanes() <= row.n; i += lanes()) total = hn::Add(total, hn::LoadU(d, values + i));
    if (i < row.n)
      total = hn::Add(total,
                      hn::IfThenElseZero(hn::FirstN(d, static_cast<std::size_t>(row.n - i)), hn::LoadU(d, values + i)));
    const double sum = static_cast<double>(hn::GetLane(hn::SumOfLanes(d, total)));
    amounts[row.ray] +=
        sum * static_cast<double>(row.step) + static_cast<double>(values[row.n - 1] * (row.last_step - row.step));
  }
}

}  // namespace
}  // namespace brume::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume {

HWY_EXPORT(ClipToBox);
HWY_EXPORT(WritePoints);
HWY_EXPORT(AddAmounts);

void clip_to_box(const ShadowRays& rays, const Affine& box_from_scene, Vec3 low, Vec3 high, float* from, float* to) {
  HWY_DYNAMIC_DISPATCH(ClipToBox)(rays, box_from_scene, low, high, from, to);
}
void write_points(const ShadowRays& rays, std::span<const ShadowRow> rows, float* x, float* y, float* z) {
  HWY_DYNAMIC_DISPATCH(WritePoints)(rays, rows, x, y, z);
}
void add_amounts(std::span<const ShadowRow> rows, const float* density, double* amounts) {
  HWY_DYNAMIC_DISPATCH(AddAmounts)(rows, density, amounts);
}

}  // namespace brume
#endif  // HWY_ONCE
