#include "renderer/media/brick_lookup.h"

#include <cmath>
#include <cstdint>
#include <cstring>

// Highway includes this file once more for every SIMD level.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/media/brick_lookup.cpp"
#include "hwy/foreach_target.h"
//
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace brume {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr int kChunk = 16;  // points that are skipped together when all their bricks are empty
// Points that go through the phases together. One phase reads what the one before wrote in pieces of another size; with
// 16 points these writes are still on their way to the cache and every read waits for them (AVX-512 on Zen 5: 8 cycles
// a point with 16, 5.8 with 32, 4.8 with 64 or more).
constexpr int kBlock = 64;

/// Hides from the optimiser where `p` comes from, so that what was written through it is really in memory: left alone,
/// GCC 12 takes the vectors apart lane by lane in registers, which costs more than the round trip through the cache.
template <class T> HWY_INLINE void pass_through_memory(T*& p) { asm volatile("" : "+r"(p) : : "memory"); }

/// What one block hands from phase to phase.
struct Scratch {
  std::int32_t slot[kBlock];    // element of the brick table
  std::int32_t corner[kBlock];  // of the cell's low voxel within its brick
  float fx[kBlock], fy[kBlock], fz[kBlock];
  float pairs[kBlock / kChunk][4][2 * kChunk];  // [chunk][(0,0) (0,1) (1,0) (1,1) in x,y][point][z, z+1]
  bool filled[kBlock / kChunk];                 // false: the bricks of the chunk are all empty
};

/// From points to table elements, voxels and fractions.
class Addresses {
 public:
  using D = hn::CappedTag<float, kChunk>;
  using DI = hn::RebindToSigned<D>;
  using V = hn::Vec<D>;

  /// `local_from_scene` maps to index space relative to the low corner of the table.
  HWY_INLINE Addresses(const BrickGrid& grid, const Affine& local_from_scene) : map_(local_from_scene) {
    const VoxelIndex bricks = grid.table_extent();
    for (int axis = 0; axis < 3; ++axis)
      last_[axis] = std::nextafter(static_cast<float>(bricks[axis] * BrickGrid::kCells), 0.0f);
    row_y_ = bricks.y, row_z_ = bricks.z;
    // As below: what the bits of 2^23 add up to in the place, to be taken away again; modulo 2^32. 1: see table().
    const auto ny = static_cast<std::uint32_t>(bricks.y), nz = static_cast<std::uint32_t>(bricks.z);
    first_slot_ = static_cast<std::int32_t>(1 - (kTwo23Bits >> 3) * (ny * nz + nz + 1));
  }

  HWY_INLINE void find(const PointBatch& points, int first, int count, Scratch* HWY_RESTRICT s) const {
    const D d;
    const DI di;
    const auto set = [d](float v) HWY_ATTR { return hn::Set(d, v); };
    const V ax = set(map_.row[0].x), ay = set(map_.row[0].y), az = set(map_.row[0].z), ao = set(map_.offset.x);
    const V bx = set(map_.row[1].x), by = set(map_.row[1].y), bz = set(map_.row[1].z), bo = set(map_.offset.y);
    const V cx = set(map_.row[2].x), cy = set(map_.row[2].y), cz = set(map_.row[2].z), co = set(map_.offset.z);
    const V zero = hn::Zero(d), last_x = set(last_[0]), last_y = set(last_[1]), last_z = set(last_[2]);
    const V two23 = set(8388608.0f);
    const auto row_y = hn::Set(di, row_y_), row_z = hn::Set(di, row_z_), first_slot = hn::Set(di, first_slot_);
    const auto seven = hn::Set(di, 7);

    for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
      const V x = hn::LoadU(d, points.x + first + i), y = hn::LoadU(d, points.y + first + i),
              z = hn::LoadU(d, points.z + first + i);
      const V px = hn::MulAdd(ax, x, hn::MulAdd(ay, y, hn::MulAdd(az, z, ao)));
      const V py = hn::MulAdd(bx, x, hn::MulAdd(by, y, hn::MulAdd(bz, z, bo)));
      const V pz = hn::MulAdd(cx, x, hn::MulAdd(cy, y, hn::MulAdd(cz, z, co)));
      // A point is inside when clamping leaves it alone; a NaN equals nothing. Points outside read element 0 of the
      // table, which is brick 0, at the low corner: whatever the clamped value is, it is not used.
      const V qx = hn::Min(hn::Max(px, zero), last_x), qy = hn::Min(hn::Max(py, zero), last_y),
              qz = hn::Min(hn::Max(pz, zero), last_z);
      const auto inside = hn::RebindMask(di, hn::And(hn::And(hn::Eq(px, qx), hn::Eq(py, qy)), hn::Eq(pz, qz)));
      const V wx = hn::Floor(qx), wy = hn::Floor(qy), wz = hn::Floor(qz);
      hn::Store(hn::Sub(qx, wx), d, s->fx + i);
      hn::Store(hn::Sub(qy, wy), d, s->fy + i);
      hn::Store(hn::Sub(qz, wz), d, s->fz + i);
      // 2^23 + w has w in its low bits: cheaper than a conversion that must also handle what does not fit.
      const auto ix = hn::BitCast(di, hn::Add(wx, two23)), iy = hn::BitCast(di, hn::Add(wy, two23)),
                 iz = hn::BitCast(di, hn::Add(wz, two23));
      const auto row = hn::Add(hn::Mul(hn::ShiftRight<3>(ix), row_y), hn::ShiftRight<3>(iy));
      const auto slot = hn::Add(hn::Mul(row, row_z), hn::Add(hn::ShiftRight<3>(iz), first_slot));
      hn::Store(hn::IfThenElseZero(inside, slot), di, s->slot + i);
      const auto lx = hn::And(ix, seven), ly = hn::And(iy, seven), lz = hn::And(iz, seven);
      const auto xy = hn::Add(times_nine(lx), ly);
      hn::Store(hn::IfThenElseZero(inside, hn::Add(times_nine(xy), lz)), di, s->corner + i);
    }
  }

 private:
  static constexpr std::uint32_t kTwo23Bits = 0x4B000000;  // 2^23 as float
  static_assert(BrickGrid::kMaxExtent <= 1 << 23 && BrickGrid::kCells == 8 && BrickGrid::kCorners == 9);

  static HWY_INLINE hn::Vec<DI> times_nine(hn::Vec<DI> v) { return hn::Add(hn::ShiftLeft<3>(v), v); }

  const Affine& map_;
  float last_[3];  // the greatest coordinate inside the table
  std::int32_t row_y_, row_z_, first_slot_;
};

/// Fetches the corners of one chunk, if any of its bricks has values. Plain code: 8-byte loads of two neighbours along
/// z beat hardware gathers twice over (march_limit.md, section 2).
HWY_INLINE bool fetch(const std::int32_t* table, const float* values, const std::int32_t* slot,
                      const std::int32_t* corner, float (*pairs)[2 * kChunk]) {
  constexpr int kStepX = BrickGrid::kCorners * BrickGrid::kCorners, kStepY = BrickGrid::kCorners;
  int empty = 0;  // a dense chunk leaves this loop at once; one of empty bricks is done after it
  while (empty < kChunk && table[slot[empty]] == 0) ++empty;
  if (empty == kChunk) return false;
  for (int k = 0; k < kChunk; ++k) {
    const float* v = values + std::int64_t{table[slot[k]]} * BrickGrid::kBrickFloats + corner[k];
    std::memcpy(pairs[0] + 2 * k, v, 8);
    std::memcpy(pairs[1] + 2 * k, v + kStepY, 8);
    std::memcpy(pairs[2] + 2 * k, v + kStepX, 8);
    std::memcpy(pairs[3] + 2 * k, v + kStepX + kStepY, 8);
  }
  return true;
}

template <class V> HWY_INLINE V lerp(V f, V a, V b) {
  return hn::MulAdd(f, hn::Sub(b, a), a);  // exactly a where a == b; never negative where a and b are not
}

/// Interpolates one chunk: along z first, then y, then x, which is OpenVDB's order.
HWY_INLINE void interpolate(const float* fx, const float* fy, const float* fz, const float (*pairs)[2 * kChunk],
                            float scale, float* out) {
  const Addresses::D d;
  const auto scale_all = hn::Set(d, scale);
  for (int i = 0; i < kChunk; i += static_cast<int>(hn::Lanes(d))) {
    const auto wz = hn::Load(d, fz + i), wy = hn::Load(d, fy + i), wx = hn::Load(d, fx + i);
    const auto along_z = [&](const float* pair) HWY_ATTR {
      const auto u = hn::Load(d, pair + 2 * i), v = hn::Load(d, pair + 2 * i + hn::Lanes(d));
#if HWY_TARGET == HWY_SCALAR
      return lerp(wz, u, v);
#else
      return lerp(wz, hn::ConcatEven(d, v, u), hn::ConcatOdd(d, v, u));
#endif
    };
    const auto low = lerp(wy, along_z(pairs[0]), along_z(pairs[1]));
    const auto high = lerp(wy, along_z(pairs[2]), along_z(pairs[3]));
    hn::StoreU(hn::Mul(lerp(wx, low, high), scale_all), d, out + i);
  }
}

void lookup(const BrickGrid& grid, const Affine& local_from_scene, const PointBatch& points, float scale, float* out) {
  alignas(64) Scratch scratch;
  const Addresses addresses(grid, local_from_scene);
  const std::int32_t* const table = grid.table();
  const float* const values = grid.values();

  for (int first = 0; first < points.n; first += kBlock) {
    const int count = HWY_MIN(kBlock, (points.n - first + kChunk - 1) & ~(kChunk - 1));
    Scratch* s = &scratch;
    addresses.find(points, first, count, s);
    pass_through_memory(s);
    for (int c = 0; c < count; c += kChunk)
      s->filled[c / kChunk] = fetch(table, values, s->slot + c, s->corner + c, s->pairs[c / kChunk]);
    pass_through_memory(s);
    for (int c = 0; c < count; c += kChunk) {
      if (s->filled[c / kChunk])
        interpolate(s->fx + c, s->fy + c, s->fz + c, s->pairs[c / kChunk], scale, out + first + c);
      else
        std::memset(out + first + c, 0, kChunk * sizeof(float));
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace brume
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume {
namespace {

HWY_EXPORT(lookup);

}  // namespace

void lookup_trilinear(const BrickGrid& grid, const Affine& index_from_scene, const PointBatch& points, float scale,
                      float* out) {
  // Relative to the table, so that an index of a million keeps its fraction: only the offset was rounded, once.
  Affine local = index_from_scene;
  local.offset = local.offset - Vec3(grid.table_origin());
  HWY_DYNAMIC_DISPATCH(lookup)(grid, local, points, scale, out);
}

void lookup_trilinear(const BrickGrid& grid, const Affined& index_from_scene, const PointBatch& points, float scale,
                      float* out) {
  Affined local = index_from_scene;
  local.offset = local.offset - Vec3d(grid.table_origin());
  HWY_DYNAMIC_DISPATCH(lookup)(grid, local.cast<float>(), points, scale, out);
}

}  // namespace brume
#endif  // HWY_ONCE
