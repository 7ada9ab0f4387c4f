#include "renderer/experiments/limit_kernels.h"

#include <algorithm>
#include <chrono>
#include <cstring>

#if defined(__x86_64__)
#include <cpuid.h>
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/experiments/limit_kernels.cpp"
#include <hwy/foreach_target.h>  // compiles this file once per instruction set

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace brume::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 16>;
using DI = hn::RebindToSigned<D>;
using DU = hn::RebindToUnsigned<D>;
using V = hn::Vec<D>;

template <class T> HWY_INLINE void pass_through_memory(T*& p) { asm volatile("" : "+r"(p) : : "memory"); }

HWY_INLINE V lerp(V f, V a, V b) { return hn::MulAdd(f, hn::Sub(b, a), a); }
HWY_INLINE V low_half(hn::Vec<DU> v) { return hn::BitCast(D(), hn::ShiftLeft<13>(hn::And(v, hn::Set(DU(), 0xFFFF)))); }
HWY_INLINE V high_half(hn::Vec<DU> v) { return hn::BitCast(D(), hn::ShiftLeft<13>(hn::ShiftRight<16>(v))); }

constexpr int kBlock = HWY_MAX_BYTES == 64 ? 128 : 64;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(D())), kParts = HWY_MAX(kLanes / 4, 1);  // of 16 bytes

/// Where the corners of a block's k-th sample are put, so that four vectors hold every fourth sample each and are
/// turned inside their parts only.
HWY_INLINE constexpr int place_of(int k) { return k / kLanes * kLanes + k % 4 * kParts + k / 4 % kParts; }

#if HWY_TARGET == HWY_SCALAR
HWY_INLINE void load_turned(const std::uint32_t* voxels, hn::Vec<DU>* out) {
  hn::LoadInterleaved4(DU(), voxels, out[0], out[1], out[2], out[3]);
}
#else
HWY_INLINE void load_turned(const std::uint32_t* voxels, hn::Vec<DU>* out) {
  const DU du;
  const hn::Repartition<std::uint64_t, DU> pairs;
  const auto v0 = hn::Load(du, voxels), v1 = hn::Load(du, voxels + kLanes), v2 = hn::Load(du, voxels + 2 * kLanes),
             v3 = hn::Load(du, voxels + 3 * kLanes);
  const auto low01 = hn::BitCast(pairs, hn::InterleaveLower(du, v0, v1)),
             low23 = hn::BitCast(pairs, hn::InterleaveLower(du, v2, v3)),
             high01 = hn::BitCast(pairs, hn::InterleaveUpper(du, v0, v1)),
             high23 = hn::BitCast(pairs, hn::InterleaveUpper(du, v2, v3));
  out[0] = hn::BitCast(du, hn::InterleaveLower(pairs, low01, low23));
  out[1] = hn::BitCast(du, hn::InterleaveUpper(pairs, low01, low23));
  out[2] = hn::BitCast(du, hn::InterleaveLower(pairs, high01, high23));
  out[3] = hn::BitCast(du, hn::InterleaveUpper(pairs, high01, high23));
}
#endif

struct Scratch {
  std::int32_t slot[kBlock], corner[kBlock];
  float fx[kBlock], fy[kBlock], fz[kBlock];
  std::uint32_t voxels[4 * kBlock];
};

void Lookup(const BrickGrid& grid, Vec3 first, Vec3 step, int n, float* out) {
  const D d;
  const DI di;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const std::uint32_t* const table = grid.table();
  const std::byte* const data = grid.values().data();
  first = first - Vec3(grid.table_origin());
  const V scale = hn::Set(d, grid.values().unit() * 0x1p112f);
  const auto ny = hn::Set(di, grid.table_extent().y), nz = hn::Set(di, grid.table_extent().z);
  const auto seven = hn::Set(di, 7);
  // Added to 2^23 a whole number is in the low bits, with those of 2^23 above, which add up to a constant in the slot.
  const V two23 = hn::Set(d, 8388608.0f);
  const auto bricks_y = static_cast<std::uint32_t>(grid.table_extent().y),
             bricks_z = static_cast<std::uint32_t>(grid.table_extent().z);
  const auto first_slot =
      hn::Set(di, static_cast<std::int32_t>(1 - (0x4B000000u >> 3) * (bricks_y * bricks_z + bricks_z + 1)));
  alignas(64) Scratch scratch;
  for (int begin = 0; begin < n; begin += kBlock) {
    Scratch* s = &scratch;
    for (int i = 0; i < kBlock; i += lanes) {
      const V k = hn::Iota(d, static_cast<float>(begin + i));
      const V x = hn::MulAdd(k, hn::Set(d, step.x), hn::Set(d, first.x)),
              y = hn::MulAdd(k, hn::Set(d, step.y), hn::Set(d, first.y)),
              z = hn::MulAdd(k, hn::Set(d, step.z), hn::Set(d, first.z));
      const V wx = hn::Floor(x), wy = hn::Floor(y), wz = hn::Floor(z);
      hn::Store(hn::Sub(x, wx), d, s->fx + i);
      hn::Store(hn::Sub(y, wy), d, s->fy + i);
      hn::Store(hn::Sub(z, wz), d, s->fz + i);
      const auto ix = hn::BitCast(di, hn::Add(wx, two23)), iy = hn::BitCast(di, hn::Add(wy, two23)),
                 iz = hn::BitCast(di, hn::Add(wz, two23));
      const auto row = hn::Add(hn::Mul(hn::ShiftRight<3>(ix), ny), hn::ShiftRight<3>(iy));
      hn::Store(hn::Add(hn::Mul(row, nz), hn::Add(hn::ShiftRight<3>(iz), first_slot)), di, s->slot + i);
      const auto xy = hn::Add(hn::ShiftLeft<3>(hn::And(ix, seven)), hn::And(iy, seven));
      hn::Store(hn::Add(hn::Add(hn::ShiftLeft<3>(xy), xy), hn::And(iz, seven)), di, s->corner + i);
    }
    pass_through_memory(s);
    for (int k = 0; k < kBlock; k += 16) {
      HWY_UNROLL(16)
      for (int j = 0; j < 16; ++j)
        std::memcpy(s->voxels + 4 * (k + place_of(j)),
                    data + std::size_t{table[s->slot[k + j]] + static_cast<std::uint32_t>(s->corner[k + j])} *
                               bytes_per_element(BrickLayout::Quad),
                    16);
    }
    pass_through_memory(s);
    for (int i = 0; i < kBlock; i += lanes) {
      hn::Vec<DU> v[4];
      load_turned(s->voxels + 4 * i, v);
      const auto low0 = v[0], low1 = v[1], high0 = v[2], high1 = v[3];
      const V fx = hn::Load(d, s->fx + i), fy = hn::Load(d, s->fy + i), fz = hn::Load(d, s->fz + i);
      const V a = lerp(fz, low_half(low0), low_half(high0)), b = lerp(fz, high_half(low0), high_half(high0));
      const V c = lerp(fz, low_half(low1), low_half(high1)), e = lerp(fz, high_half(low1), high_half(high1));
      hn::StoreU(hn::Mul(scale, lerp(fx, lerp(fy, a, b), lerp(fy, c, e))), d, out + begin + i);
    }
  }
}

/// exp(-x) for x in [0, 80], relative error below 4e-6: 2^k times a polynomial.
HWY_INLINE V exp_minus(V x) {
  const D d;
  const V y = hn::Mul(x, hn::Set(d, -1.44269504f)), k = hn::Round(y), f = hn::Sub(y, k);
  V p = hn::Set(d, 0.00133336f);
  p = hn::MulAdd(p, f, hn::Set(d, 0.00961813f));
  p = hn::MulAdd(p, f, hn::Set(d, 0.05550411f));
  p = hn::MulAdd(p, f, hn::Set(d, 0.24022651f));
  p = hn::MulAdd(p, f, hn::Set(d, 0.69314718f));
  p = hn::MulAdd(p, f, hn::Set(d, 1.0f));
  const auto exponent = hn::ShiftLeft<23>(hn::Add(hn::ConvertTo(DI(), k), hn::Set(DI(), 127)));
  return hn::Mul(p, hn::BitCast(d, exponent));
}

template <int kBy> HWY_INLINE V add_from_below(V v) {
  const DI di;
  const auto from = hn::Sub(hn::Iota(di, 0), hn::Set(di, kBy));
  const auto index = hn::IndicesFromVec(D(), hn::Max(from, hn::Zero(di)));
  const auto low = hn::RebindMask(D(), hn::Lt(from, hn::Zero(di)));
  return hn::Add(v, hn::IfThenZeroElse(low, hn::TableLookupLanes(v, index)));
}

HWY_INLINE V running_sums(V v) {
  const int lanes = static_cast<int>(hn::Lanes(D()));
  if (lanes > 1) v = add_from_below<1>(v);
  if (lanes > 2) v = add_from_below<2>(v);
  if (lanes > 4) v = add_from_below<4>(v);
  if (lanes > 8) v = add_from_below<8>(v);
  return v;
}

void Distribute(const float* density, int n, float sigma_t, float sigma_s, float delta, float* transmittance,
                float* cdf) {
  const D d;
  const auto last = hn::IndicesFromVec(d, hn::Set(DI(), static_cast<int>(hn::Lanes(d)) - 1));
  const V tau_of = hn::Set(d, sigma_t * delta), scattered = hn::Set(d, sigma_s * delta);
  const int lanes = static_cast<int>(hn::Lanes(d));
  V depth = hn::Zero(d), sum = hn::Zero(d);
  for (int i = 0; i < n; i += lanes) {
    const V x = hn::Mul(hn::LoadU(d, density + i), tau_of), within = running_sums(x);
    hn::StoreU(exp_minus(hn::Add(depth, hn::Sub(within, x))), d, transmittance + i);
    depth = hn::Add(depth, hn::TableLookupLanes(within, last));
  }
  // A loop of its own, so that more vectors are worked on at once.
  for (int i = 0; i < n; i += lanes) {
    const V t = hn::LoadU(d, transmittance + i);
    const V within = running_sums(hn::Mul(hn::Mul(hn::LoadU(d, density + i), scattered), t));
    hn::StoreU(hn::Add(sum, within), d, cdf + i);
    sum = hn::Add(sum, hn::TableLookupLanes(within, last));
  }
}

}  // namespace
}  // namespace brume::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume {

HWY_EXPORT(Lookup);
HWY_EXPORT(Distribute);

LimitCycles limit_cycles(const std::string& level) {
  if (level.starts_with("avx3")) return {.lookup = 3.5, .distribute = 1.8, .noise_octave = 5.6};
  if (level == "avx2") return {.lookup = 5.5, .distribute = 2.8, .noise_octave = 12.4};
  return {};
}

bool is_processor_of_limit_cycles() {
#if defined(__x86_64__)
  unsigned eax = 0, ebx = 0, ecx = 0, edx = 0;
  constexpr unsigned kExtended = 0xF, kZen5 = 0x1A;
  if (!__get_cpuid(1, &eax, &ebx, &ecx, &edx)) return false;
  return (eax >> 8 & kExtended) == kExtended && (eax >> 8 & kExtended) + (eax >> 20 & 0xFF) == kZen5;
#else
  return false;
#endif
}

void limit_lookup(const BrickGrid& grid, Vec3 first, Vec3 step, int n, float* out) {
  HWY_DYNAMIC_DISPATCH(Lookup)(grid, first, step, n, out);
}

void limit_distribute(const float* density, int n, float sigma_t, float sigma_s, float delta, float* transmittance,
                      float* cdf) {
  HWY_DYNAMIC_DISPATCH(Distribute)(density, n, sigma_t, sigma_s, delta, transmittance, cdf);
}

double cycles_per_nanosecond() {
  constexpr int kRounds = 100000, kCyclesPerRound = 6;
  double best = 0;  // a round that is interrupted makes the clock look slow
  for (int attempt = 0; attempt < 5; ++attempt) {
    std::uint64_t x = 1;
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < kRounds; ++i) {
      x ^= x << 13;
      x ^= x >> 7;
      x ^= x << 17;
      asm volatile("" : "+r"(x));
    }
    const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - start;
    best = std::max(best, kRounds * kCyclesPerRound / time.count());
  }
  return best;
}

}  // namespace brume
#endif  // HWY_ONCE
