#include "renderer/media/fbm_noise.h"

#include <algorithm>
#include <cmath>

// Highway includes this file once more for every SIMD level.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/media/fbm_noise.cpp"
#include "hwy/foreach_target.h"
//
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace brume::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using F = hn::CappedTag<float, 16>;  // arrays are padded to 16 values
using U = hn::RebindToUnsigned<F>;
using VF = hn::Vec<F>;
using VU = hn::Vec<U>;

/// One axis of a lattice cell.
struct Axis {
  VU hash0, hash1;  // of the cell's low and high corner
  VF to0, to1;      // from the corners to the point, in [0,1] and [-1,0]
  VF fade;          // weight of the high corner
};

/// @param x  lattice coordinate less 1/2
HWY_INLINE Axis make_axis(VF x, std::uint32_t prime, VU seed) {
  const F f;
  const U u;
  // 1.5 2^23 has a last place of 1, so adding it rounds to an integer and leaves that in the low mantissa bits: floor
  // and conversion in one addition, for either sign. A point on a border may go to either cell: both agree there.
  const VF magic = hn::Set(f, 12582912.0f);
  const VF shifted = hn::Add(x, magic);
  const VF r = hn::Sub(x, hn::Sub(shifted, magic));
  const VF half = hn::Set(f, 0.5f);
  // Beyond 2^22 the sum rounds to more than 1 and r leaves the cell; kept inside, everything stays finite.
  const VF centered = hn::Min(hn::Max(r, hn::Set(f, -0.5f)), half);

  Axis axis;
  axis.hash0 = hn::Add(hn::Mul(hn::BitCast(u, shifted), hn::Set(u, prime)), seed);
  axis.hash1 = hn::Add(axis.hash0, hn::Set(u, prime));
  axis.to0 = hn::Add(centered, half);
  axis.to1 = hn::Sub(centered, half);
  // 6t^5 - 15t^4 + 10t^3 for t = r + 1/2 is 1/2 + r (15/8 - 5 r^2 + 6 r^4): odd about the middle of the cell.
  const VF r2 = hn::Mul(centered, centered);
  const VF poly = hn::MulAdd(hn::MulAdd(hn::Set(f, 6.0f), r2, hn::Set(f, -5.0f)), r2, hn::Set(f, 1.875f));
  axis.fade = hn::MulAdd(centered, poly, half);
  return axis;
}

/// dot(gradient of the corner, vector to the point).
HWY_INLINE VF corner(VU hash, VF dx, VF dy, VF dz) {
  const F f;
  const U u;
  // The exclusive or of the three axes is folded and multiplied: no correlation is found between the components of any
  // two corners up to 4 cells apart (3600 pairs of 64^3 cells, chi-square per pair 1.01); without the fold there is.
  hash = hn::Xor(hash, hn::ShiftRight<15>(hash));
  hash = hn::Mul(hash, hn::Set(u, 0x27D4EB2Fu));
  // The components are floats made of hash bits: sign, two bits of exponent, mantissa; +-[1/8, 2). That is nearly
  // isotropic to the fourth moments (E gx^4 / (3 E gx^2 gy^2) = 0.9; Perlin's twelve edges have 0.67) and costs a shift
  // and an and-or. The fields overlap only where one of them has its low mantissa bits, which hardly matter.
  const VU field = hn::Set(u, 0x81FFFFFFu), eighth = hn::Set(u, 0x3E000000u);
  const VF gx = hn::BitCast(f, hn::OrAnd(eighth, hash, field));
  const VF gy = hn::BitCast(f, hn::OrAnd(eighth, hn::ShiftLeft<5>(hash), field));
  const VF gz = hn::BitCast(f, hn::OrAnd(eighth, hn::ShiftLeft<11>(hash), field));
  return hn::MulAdd(gx, dx, hn::MulAdd(gy, dy, hn::Mul(gz, dz)));
}

HWY_INLINE VF lerp(VF t, VF a, VF b) { return hn::MulAdd(t, hn::Sub(b, a), a); }

HWY_INLINE VF gradient_noise(const Axis& x, const Axis& y, const Axis& z) {
  const auto along_x = [&x](VU hash_yz, VF dy, VF dz) HWY_ATTR {
    return lerp(x.fade, corner(hn::Xor(x.hash0, hash_yz), x.to0, dy, dz),
                corner(hn::Xor(x.hash1, hash_yz), x.to1, dy, dz));
  };
  const auto along_y = [&](VU hash_z, VF dz) HWY_ATTR {
    return lerp(y.fade, along_x(hn::Xor(y.hash0, hash_z), y.to0, dz), along_x(hn::Xor(y.hash1, hash_z), y.to1, dz));
  };
  return lerp(z.fade, along_y(z.hash0, z.to0), along_y(z.hash1, z.to1));
}

void evaluate_fbm(const FbmNoise::Octave* octaves, int count, float constant, const PointBatch& points,
                  float* HWY_RESTRICT out) {
  const F f;
  const U u;
  const auto coordinate = [f](const FbmNoise::Octave& octave, int axis, VF x, VF y, VF z) HWY_ATTR {
    const Vec3 row = octave.row[axis];
    const VF z_part = hn::MulAdd(hn::Set(f, row.z), z, hn::Set(f, octave.offset[axis]));
    return hn::MulAdd(hn::Set(f, row.x), x, hn::MulAdd(hn::Set(f, row.y), y, z_part));
  };
  for (int i = 0; i < points.n; i += static_cast<int>(hn::Lanes(f))) {
    const VF x = hn::LoadU(f, points.x + i), y = hn::LoadU(f, points.y + i), z = hn::LoadU(f, points.z + i);
    VF sum = hn::Set(f, constant);
    for (int o = 0; o < count; ++o) {
      const FbmNoise::Octave& octave = octaves[o];
      // Odd and far apart in their bits: the golden ratio, and two primes of xxHash (Collet 2012).
      const Axis ax = make_axis(coordinate(octave, 0, x, y, z), 0x9E3779B1u, hn::Set(u, octave.seed));
      const Axis ay = make_axis(coordinate(octave, 1, x, y, z), 0x85EBCA77u, hn::Zero(u));
      const Axis az = make_axis(coordinate(octave, 2, x, y, z), 0xC2B2AE3Du, hn::Zero(u));
      const VF n = gradient_noise(ax, ay, az);
      sum = hn::MulAdd(n, hn::Set(f, octave.linear), hn::MulAdd(hn::Abs(n), hn::Set(f, octave.absolute), sum));
    }
    hn::StoreU(sum, f, out + i);
  }
}

}  // namespace
}  // namespace brume::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume {
namespace {

HWY_EXPORT(evaluate_fbm);

// Of one octave of the kernel's noise, over all places and seeds; all but the first measured over 10^7 points.
constexpr double kPeak = 3;  // every |component| < 2, and sum over the axes of max over t of |(1-s)t + s(1-t)| is 3/2
constexpr double kDeviation = 0.291;
constexpr double kAbsoluteMean = 0.2297;
constexpr double kAbsoluteDeviation = 0.1785;

constexpr double kTargetDeviation = 0.3;  // of the sum
constexpr double kMaxFrequency = 1e12;    // keeps lattice coordinates far from infinity

/// A permutation of the integers without structure (Wellons 2018, "Prospecting for Hash Functions", lowbias32).
std::uint32_t mix(std::uint32_t h) {
  h = (h ^ (h >> 16)) * 0x7FEB352Du;
  h = (h ^ (h >> 15)) * 0x846CA68Bu;
  return h ^ (h >> 16);
}

double unit(std::uint32_t h) { return h * 0x1p-32; }

}  // namespace

FbmNoise::FbmNoise(const Affine& to_noise, const FbmSettings& settings) {
  count_ = std::clamp(settings.octaves, 1, kMaxFbmOctaves);
  const double gain = std::max(settings.gain, 0.0f), lacunarity = std::max(settings.lacunarity, 1.0f);
  const double billow = std::clamp(settings.billow, 0.0f, 1.0f);

  // n and |n| are uncorrelated, so with these factors the variance does not depend on billow.
  const double linear = std::sqrt(1 - billow), absolute = std::sqrt(billow) * kDeviation / kAbsoluteDeviation;
  double sum = 0, sum_of_squares = 0, weight = 1;
  for (int o = 0; o < count_; ++o, weight *= gain) sum += weight, sum_of_squares += weight * weight;
  const double scale = kTargetDeviation / (kDeviation * std::sqrt(sum_of_squares));
  constant_ = static_cast<float>(-scale * sum * absolute * kAbsoluteMean);
  bound_ = static_cast<float>(scale * sum * ((linear + absolute) * kPeak - absolute * kAbsoluteMean));

  const Affined base = to_noise.cast<double>();
  double frequency = std::max(settings.frequency, 0.0f);
  weight = scale;
  for (int o = 0; o < count_; ++o, weight *= gain, frequency *= lacunarity) {
    // Turns by multiples of irrational parts of a circle come back neither to the axes nor to each other. The parts are
    // those of the R3 sequence (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences").
    const double turn = 360 * (o + 0.5);
    const Affined rotate = rotation_deg({turn * 0.8191725134, turn * 0.6710436067, turn * 0.5497004779});
    const std::uint32_t seed = mix(settings.seed ^ mix(static_cast<std::uint32_t>(o) + 1));
    const Vec3d offset{unit(mix(seed + 1)), unit(mix(seed + 2)), unit(mix(seed + 3))};
    const Vec3d stretch(std::min(frequency, kMaxFrequency));
    const Affine lattice = (translation(offset - Vec3d(0.5)) * scaling(stretch) * rotate * base).cast<float>();

    octaves_[static_cast<std::size_t>(o)] = {.row = {lattice.row[0], lattice.row[1], lattice.row[2]},
                                             .offset = lattice.offset,
                                             .seed = seed,
                                             .linear = static_cast<float>(weight * linear),
                                             .absolute = static_cast<float>(weight * absolute)};
  }
}

void FbmNoise::evaluate(const PointBatch& points, float* out) const {
  HWY_DYNAMIC_DISPATCH(evaluate_fbm)(octaves_.data(), count_, constant_, points, out);
}

void fbm_noise(const PointBatch& local_points, const Affine& to_noise, const FbmSettings& settings, float* out) {
  FbmNoise(to_noise, settings).evaluate(local_points, out);
}

}  // namespace brume
#endif  // HWY_ONCE
