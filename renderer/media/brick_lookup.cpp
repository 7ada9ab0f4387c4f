#include "renderer/media/brick_lookup.h"

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
// a point with 16, 5.8 with 32, 4.8 with 64 or more). With 128 a usual ray is one block, without a small one behind it
// (3 % of a whole camera ray); narrower vectors take longer anyway.
constexpr int kBlock = HWY_MAX_BYTES == 64 ? 128 : 64;

/// Hides from the optimiser where `p` comes from, so that what was written through it is really in memory: left alone,
/// GCC 12 takes the vectors apart lane by lane in registers, which costs more than the round trip through the cache.
template <class T> HWY_INLINE void pass_through_memory(T*& p) { asm volatile("" : "+r"(p) : : "memory"); }

/// What one block hands from phase to phase.
struct Scratch {
  std::int32_t slot[kBlock];    // entry of the brick table
  std::int32_t corner[kBlock];  // of the cell's low voxel within its brick
  float fx[kBlock], fy[kBlock], fz[kBlock];
  std::uint32_t voxels[kBlock / kChunk][8 * kChunk];  // of the corners, as the layout wants them
  bool filled[kBlock / kChunk];                       // false: the bricks of the chunk are all empty
};

/// From points to table entries, voxels and fractions.
class Addresses {
 public:
  using D = hn::CappedTag<float, kChunk>;
  using DI = hn::RebindToSigned<D>;
  using DU = hn::RebindToUnsigned<D>;
  using V = hn::Vec<D>;

  /// `local_from_scene` maps to index space relative to the low corner of the table.
  HWY_INLINE Addresses(const BrickGrid& grid, const Affine& local_from_scene) : map_(local_from_scene) {
    const VoxelIndex bricks = grid.table_extent();
    for (int axis = 0; axis < 3; ++axis) end_[axis] = static_cast<float>(bricks[axis] * BrickGrid::kCells);
    row_y_ = bricks.y, row_z_ = bricks.z;
    // As below: what the bits of 2^23 add up to in the place, to be taken away again; modulo 2^32. 1: see table().
    const auto ny = static_cast<std::uint32_t>(bricks.y), nz = static_cast<std::uint32_t>(bricks.z);
    first_slot_ = static_cast<std::int32_t>(1 - (kTwo23Bits >> 3) * (ny * nz + nz + 1));
  }

  /// @tparam kRowStride  rows of 9 voxels from x to x + 1: 9 or 8
  template <int kRowStride>
  HWY_INLINE void find(const PointBatch& points, int first, int count, Scratch* HWY_RESTRICT s) const {
    // Most grids lie along the axes of the scene.
    const Vec3* const row = map_.row;
    const bool along_axes =
        row[0].y == 0 && row[0].z == 0 && row[1].x == 0 && row[1].z == 0 && row[2].x == 0 && row[2].y == 0;
    along_axes ? find<kRowStride, true>(points, first, count, s) : find<kRowStride, false>(points, first, count, s);
  }

 private:
  template <int kRowStride, bool kAlongAxes>
  HWY_INLINE void find(const PointBatch& points, int first, int count, Scratch* HWY_RESTRICT s) const {
    const D d;
    const DI di;
    const DU du;
    const auto set = [d](float v) HWY_ATTR { return hn::Set(d, v); };
    const V ax = set(map_.row[0].x), ay = set(map_.row[0].y), az = set(map_.row[0].z), ao = set(map_.offset.x);
    const V bx = set(map_.row[1].x), by = set(map_.row[1].y), bz = set(map_.row[1].z), bo = set(map_.offset.y);
    const V cx = set(map_.row[2].x), cy = set(map_.row[2].y), cz = set(map_.row[2].z), co = set(map_.offset.z);
    const auto end_x = hn::BitCast(du, set(end_[0])), end_y = hn::BitCast(du, set(end_[1])),
               end_z = hn::BitCast(du, set(end_[2]));
    const V two23 = set(8388608.0f);
    const auto row_y = hn::Set(di, row_y_), row_z = hn::Set(di, row_z_), first_slot = hn::Set(di, first_slot_);
    const auto seven = hn::Set(di, 7);

    for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
      const V x = hn::LoadU(d, points.x + first + i), y = hn::LoadU(d, points.y + first + i),
              z = hn::LoadU(d, points.z + first + i);
      const V px = kAlongAxes ? hn::MulAdd(ax, x, ao) : hn::MulAdd(ax, x, hn::MulAdd(ay, y, hn::MulAdd(az, z, ao)));
      const V py = kAlongAxes ? hn::MulAdd(by, y, bo) : hn::MulAdd(bx, x, hn::MulAdd(by, y, hn::MulAdd(bz, z, bo)));
      const V pz = kAlongAxes ? hn::MulAdd(cz, z, co) : hn::MulAdd(cx, x, hn::MulAdd(cy, y, hn::MulAdd(cz, z, co)));
      // Inside is 0 <= p < end: as an unsigned number a float is the greater the farther it is from 0, and greater than
      // all that are not negative if it is. Infinities and NaN are outside. Points outside read entry 0 of the table,
      // which is brick 0, somewhere: it is 0 everywhere.
      const auto inside = hn::And(hn::And(hn::Lt(hn::BitCast(du, px), end_x), hn::Lt(hn::BitCast(du, py), end_y)),
                                  hn::Lt(hn::BitCast(du, pz), end_z));
      const auto is_inside = hn::RebindMask(d, inside);
      const V wx = hn::Floor(px), wy = hn::Floor(py), wz = hn::Floor(pz);
      hn::Store(hn::IfThenElseZero(is_inside, hn::Sub(px, wx)), d, s->fx + i);
      hn::Store(hn::IfThenElseZero(is_inside, hn::Sub(py, wy)), d, s->fy + i);
      hn::Store(hn::IfThenElseZero(is_inside, hn::Sub(pz, wz)), d, s->fz + i);
      // 2^23 + w has w in its low bits: cheaper than a conversion that must also handle what does not fit.
      const auto ix = hn::BitCast(di, hn::Add(wx, two23)), iy = hn::BitCast(di, hn::Add(wy, two23)),
                 iz = hn::BitCast(di, hn::Add(wz, two23));
      const auto row = hn::Add(hn::Mul(hn::ShiftRight<3>(ix), row_y), hn::ShiftRight<3>(iy));
      const auto slot = hn::Add(hn::Mul(row, row_z), hn::Add(hn::ShiftRight<3>(iz), first_slot));
      hn::Store(hn::IfThenElseZero(hn::RebindMask(di, inside), slot), di, s->slot + i);
      const auto lx = hn::And(ix, seven), ly = hn::And(iy, seven), lz = hn::And(iz, seven);
      const auto xy = hn::Add(kRowStride == 9 ? times_nine(lx) : hn::ShiftLeft<3>(lx), ly);
      hn::Store(hn::Add(times_nine(xy), lz), di, s->corner + i);
    }
  }

  static constexpr std::uint32_t kTwo23Bits = 0x4B000000;  // 2^23 as float
  static_assert(BrickGrid::kMaxExtent <= 1 << 23 && BrickValues::kCells == 8 && BrickValues::kCorners == 9);

  static HWY_INLINE hn::Vec<DI> times_nine(hn::Vec<DI> v) { return hn::Add(hn::ShiftLeft<3>(v), v); }

  const Affine& map_;
  float end_[3];  // of the table, from its low corner
  std::int32_t row_y_, row_z_, first_slot_;
};

using D = Addresses::D;
using DU = Addresses::DU;
using V = hn::Vec<D>;

HWY_INLINE V lerp(V f, V a, V b) {
  return hn::MulAdd(f, hn::Sub(b, a), a);  // exactly a where a == b; never negative where a and b are not
}

/// The four values of a cell's edges along z, at the height of the points: (x,y) (x,y+1) (x+1,y) (x+1,y+1).
struct Edges {
  V v[4];
};

// Every layout tells how voxels are fetched to scratch, and how they are read there. Plain code fetches: loads of 8 or
// 16 bytes beat hardware gathers twice over (march_limit.md, section 2).

/// 2^112 times the float with the digits of a half float: as good, for positive ones, as the value itself.
HWY_INLINE V shifted_half(hn::Vec<DU> bits) { return hn::BitCast(D(), hn::ShiftLeft<13>(bits)); }
constexpr float kShiftedHalf = 0x1p112f;

struct FullLayout {
  static constexpr std::size_t kBytes = bytes_per_element(BrickLayout::Full);
  static constexpr int kRowStride = 9;
  static float unit(const BrickValues&) { return 1; }

  static HWY_INLINE void fetch(const std::byte* corner, int k, std::uint32_t* voxels) {
    for (int edge = 0; edge < 4; ++edge)
      std::memcpy(voxels + (edge * kChunk + k) * 2, corner + (81 * (edge / 2) + 9 * (edge % 2)) * kBytes, 8);
  }
  static HWY_INLINE Edges read(const std::uint32_t* voxels, int i, V along_z) {
    const D d;
    Edges edges;
    for (int edge = 0; edge < 4; ++edge) {
      const float* pair = reinterpret_cast<const float*>(voxels) + 2 * (edge * kChunk + i);
      const auto u = hn::Load(d, pair), v = hn::Load(d, pair + hn::Lanes(d));
#if HWY_TARGET == HWY_SCALAR
      edges.v[edge] = lerp(along_z, u, v);
#else
      edges.v[edge] = lerp(along_z, hn::ConcatEven(d, v, u), hn::ConcatOdd(d, v, u));
#endif
    }
    return edges;
  }
};

struct HalfLayout {
  static constexpr std::size_t kBytes = bytes_per_element(BrickLayout::Half);
  static constexpr int kRowStride = 9;
  static float unit(const BrickValues& values) { return values.unit() * kShiftedHalf; }

  static HWY_INLINE void fetch(const std::byte* corner, int k, std::uint32_t* voxels) {
    for (int edge = 0; edge < 4; ++edge)
      std::memcpy(voxels + edge * kChunk + k, corner + (81 * (edge / 2) + 9 * (edge % 2)) * kBytes, 4);
  }
  static HWY_INLINE Edges read(const std::uint32_t* voxels, int i, V along_z) {
    const DU du;
    Edges edges;
    for (int edge = 0; edge < 4; ++edge) {
      const auto pair = hn::Load(du, voxels + edge * kChunk + i);
      edges.v[edge] =
          lerp(along_z, shifted_half(hn::And(pair, hn::Set(du, 0xFFFF))), shifted_half(hn::ShiftRight<16>(pair)));
    }
    return edges;
  }
};

struct QuadLayout {
  static constexpr std::size_t kBytes = bytes_per_element(BrickLayout::Quad);
  static constexpr int kRowStride = 8;
  static float unit(const BrickValues& values) { return values.unit() * kShiftedHalf; }

  // Of four points in a row each goes to another vector, so that these are turned inside their blocks of 16 bytes only.
  static HWY_INLINE void fetch(const std::byte* corner, int k, std::uint32_t* voxels) {
    constexpr int kLanes = static_cast<int>(hn::MaxLanes(D())), kBlocks = HWY_MAX(kLanes / 4, 1);
    const int vector = k / 4 / kBlocks * 4 + k % 4, block = k / 4 % kBlocks;
    std::memcpy(voxels + 4 * (vector * kBlocks + block), corner, 16);
  }
  static HWY_INLINE Edges read(const std::uint32_t* voxels, int i, V along_z) {
    const DU du;
    hn::Vec<DU> low0, low1, high0, high1;  // z and z + 1, each x and x + 1, each two halves y and y + 1
#if HWY_TARGET == HWY_SCALAR
    hn::LoadInterleaved4(du, voxels + 4 * i, low0, low1, high0, high1);
#else
    const std::size_t lanes = hn::Lanes(du);
    const std::uint32_t* const first = voxels + 4 * i;
    const auto v0 = hn::Load(du, first), v1 = hn::Load(du, first + lanes), v2 = hn::Load(du, first + 2 * lanes),
               v3 = hn::Load(du, first + 3 * lanes);
    const hn::Repartition<std::uint64_t, DU> pairs;
    const auto low01 = hn::BitCast(pairs, hn::InterleaveLower(du, v0, v1)),
               low23 = hn::BitCast(pairs, hn::InterleaveLower(du, v2, v3)),
               high01 = hn::BitCast(pairs, hn::InterleaveUpper(du, v0, v1)),
               high23 = hn::BitCast(pairs, hn::InterleaveUpper(du, v2, v3));
    low0 = hn::BitCast(du, hn::InterleaveLower(pairs, low01, low23));
    low1 = hn::BitCast(du, hn::InterleaveUpper(pairs, low01, low23));
    high0 = hn::BitCast(du, hn::InterleaveLower(pairs, high01, high23));
    high1 = hn::BitCast(du, hn::InterleaveUpper(pairs, high01, high23));
#endif
    const auto mask = hn::Set(du, 0xFFFF);
    const auto y0 = [&](hn::Vec<DU> v) HWY_ATTR { return shifted_half(hn::And(v, mask)); };
    const auto y1 = [&](hn::Vec<DU> v) HWY_ATTR { return shifted_half(hn::ShiftRight<16>(v)); };
    return {{lerp(along_z, y0(low0), y0(high0)), lerp(along_z, y1(low0), y1(high0)), lerp(along_z, y0(low1), y0(high1)),
             lerp(along_z, y1(low1), y1(high1))}};
  }
};

/// Fetches the corners of one chunk, if any of its bricks has values.
template <class Layout>
HWY_INLINE bool fetch(const std::uint32_t* table, const std::byte* values, const std::int32_t* slot,
                      const std::int32_t* corner, std::uint32_t* voxels) {
  int empty = 0;  // a dense chunk leaves this loop at once; one of empty bricks is done after it
  while (empty < kChunk && table[slot[empty]] == 0) ++empty;
  if (empty == kChunk) return false;
  HWY_UNROLL(16)
  for (int k = 0; k < kChunk; ++k)
    Layout::fetch(values + std::size_t{table[slot[k]] + static_cast<std::uint32_t>(corner[k])} * Layout::kBytes, k,
                  voxels);
  return true;
}

/// Interpolates one chunk: along z first, then y, then x, which is OpenVDB's order.
template <class Layout>
HWY_INLINE void interpolate(const float* fx, const float* fy, const float* fz, const std::uint32_t* voxels, float scale,
                            float* out) {
  const D d;
  const auto scale_all = hn::Set(d, scale);
  for (int i = 0; i < kChunk; i += static_cast<int>(hn::Lanes(d))) {
    const Edges edges = Layout::read(voxels, i, hn::Load(d, fz + i));
    const auto wy = hn::Load(d, fy + i), wx = hn::Load(d, fx + i);
    const auto low = lerp(wy, edges.v[0], edges.v[1]), high = lerp(wy, edges.v[2], edges.v[3]);
    hn::StoreU(hn::Mul(lerp(wx, low, high), scale_all), d, out + i);
  }
}

template <class Layout>
void lookup_in(const BrickGrid& grid, const Affine& local_from_scene, const PointBatch& points, float scale,
               float* out) {
  alignas(64) Scratch scratch;
  const Addresses addresses(grid, local_from_scene);
  const std::uint32_t* const table = grid.table();
  const std::byte* const values = grid.values().data();
  scale *= Layout::unit(grid.values());

  for (int first = 0; first < points.n; first += kBlock) {
    const int count = HWY_MIN(kBlock, (points.n - first + kChunk - 1) & ~(kChunk - 1));
    Scratch* s = &scratch;
    addresses.find<Layout::kRowStride>(points, first, count, s);
    pass_through_memory(s);
    for (int c = 0; c < count; c += kChunk)
      s->filled[c / kChunk] = fetch<Layout>(table, values, s->slot + c, s->corner + c, s->voxels[c / kChunk]);
    pass_through_memory(s);
    for (int c = 0; c < count; c += kChunk) {
      if (s->filled[c / kChunk])
        interpolate<Layout>(s->fx + c, s->fy + c, s->fz + c, s->voxels[c / kChunk], scale, out + first + c);
      else
        std::memset(out + first + c, 0, kChunk * sizeof(float));
    }
  }
}

void lookup(const BrickGrid& grid, const Affine& local_from_scene, const PointBatch& points, float scale, float* out) {
  switch (grid.values().layout()) {
    case BrickLayout::Full:
      return lookup_in<FullLayout>(grid, local_from_scene, points, scale, out);
    case BrickLayout::Half:
      return lookup_in<HalfLayout>(grid, local_from_scene, points, scale, out);
    case BrickLayout::Quad:
      return lookup_in<QuadLayout>(grid, local_from_scene, points, scale, out);
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
