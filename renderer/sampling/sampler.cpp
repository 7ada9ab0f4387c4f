#include "renderer/sampling/sampler.h"

#include <bit>
#include <boost/random/sobol.hpp>

namespace brume {
namespace {

/// A bijection of 64 bits that mixes well. Steele et al. 2014, "Fast Splittable Pseudorandom Number Generators",
/// variant 13 of Stafford's finalizers.
std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

std::uint64_t combine(std::uint64_t key, std::uint64_t value) { return mix(key + 0x9e3779b97f4a7c15ull * (value + 1)); }

/// The upper 24 bits, so that the float is exact and stays below 1.
float to_unit(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

std::uint32_t reverse_bits(std::uint32_t v) {
  v = ((v >> 1) & 0x55555555u) | ((v & 0x55555555u) << 1);
  v = ((v >> 2) & 0x33333333u) | ((v & 0x33333333u) << 2);
  v = ((v >> 4) & 0x0f0f0f0fu) | ((v & 0x0f0f0f0fu) << 4);
  v = ((v >> 8) & 0x00ff00ffu) | ((v & 0x00ff00ffu) << 8);
  return (v >> 16) | (v << 16);
}

std::uint32_t laine_karras_round(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

/// Owen scrambling of a bit-reversed number: every bit is flipped by a hash of the bits below it.
/// Laine & Karras 2011, "Stratified Sampling for Stochastic Transparency", section 3.1; this hash by Vegdahl 2021,
/// "Building a Better LK Hash". Two rounds: after one, some pairs of dimensions are correlated in their first digits.
/// Bit k of the result knows the lowest bits of the seed only, so the rounds must not have the same ones.
std::uint32_t laine_karras(std::uint32_t x, std::uint32_t seed) {
  for (int round = 0; round < 2; ++round, seed = std::rotl(seed, 15) * 0x9e3779b9u) x = laine_karras_round(x, seed);
  return x;
}

std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
  return reverse_bits(laine_karras(reverse_bits(x), seed));
}

/// Second dimension of the Sobol' sequence, whose matrix is Pascal's triangle modulo 2, digits in reverse.
std::uint32_t sobol_second(std::uint32_t index) {
  index ^= (index & 0xaaaaaaaau) >> 1;
  index ^= (index & 0xccccccccu) >> 2;
  index ^= (index & 0xf0f0f0f0u) >> 4;
  index ^= (index & 0xff00ff00u) >> 8;
  index ^= (index & 0xffff0000u) >> 16;
  return index;
}

/// Point number `index` of a (0,2)-sequence whose order and digits are scrambled by `key`: Burley 2020, section 4
/// (padding: every pair of dimensions has its own shuffle).
class PaddedPoint {
 public:
  PaddedPoint(std::uint32_t index, std::uint64_t key)
      : index_(owen_scramble(index, static_cast<std::uint32_t>(key))), key_(mix(key)) {}
  // The first Sobol' dimension is the bit-reversed index, so one of the two reversals cancels.
  std::uint32_t x() const { return reverse_bits(laine_karras(index_, static_cast<std::uint32_t>(key_))); }
  std::uint32_t y() const {
    return reverse_bits(laine_karras(sobol_second(index_), static_cast<std::uint32_t>(key_ >> 32)));
  }

 private:
  std::uint32_t index_;
  std::uint64_t key_;
};

using Matrix = std::array<std::uint32_t, 32>;  // column j: what bit j of the index adds to the digits

/// The matrices of the first dimensions, with the direction numbers of
/// Joe & Kuo 2008 that Boost holds.
const std::array<Matrix, Sampler::kJointDimensions>& sobol_matrices() {
  static const auto matrices = [] {
    std::array<Matrix, Sampler::kJointDimensions> all;
    boost::random::sobol_engine<std::uint32_t, 32> engine(all.size());
    for (unsigned j = 0; j < 32; ++j) {
      // Boost runs through the points in the order of Gray's code and leaves out the first, which is 0: this is the one
      // whose index has bit j only.
      engine.seed((std::uint64_t{1} << (j + 1)) - 2);
      for (Matrix& matrix : all) matrix[j] = reverse_bits(engine());
    }
    return all;
  }();
  return matrices;
}

/// The first digits, in reverse, of the numbers that the pixels of a block share out among themselves, one set for each
/// dimension: linear maps of the pixel's place, so that a block hits every sixteenth of [0, 1) once and each of its
/// quarters every quarter; otherwise random.
constexpr int kBlockSide = 4, kBlockPixels = kBlockSide * kBlockSide, kBlockDigits = 4;
using BlockDigits = std::array<std::uint32_t, kBlockPixels>;

const std::array<BlockDigits, Sampler::kJointDimensions>& block_digits() {
  static const auto digits = [] {
    std::array<BlockDigits, Sampler::kJointDimensions> all{};
    for (std::size_t d = 0; d < all.size(); ++d) {
      // Columns of a 4x4 matrix modulo 2 of which the upper left quarter and the lower right one are invertible, the
      // lower left one is 0 and the upper right one free.
      const std::uint64_t bits = mix(0x6272756d65ull + d);
      constexpr std::uint32_t kInvertible[][2] = {{1, 2}, {2, 1}, {1, 3}, {3, 1}, {2, 3}, {3, 2}};
      const auto& upper = kInvertible[bits % 6];
      const auto& lower = kInvertible[bits / 6 % 6];
      const std::uint32_t column[kBlockDigits] = {upper[0], upper[1],
                                                  lower[0] << 2 | static_cast<std::uint32_t>(bits >> 32 & 3),
                                                  lower[1] << 2 | static_cast<std::uint32_t>(bits >> 34 & 3)};
      for (std::uint32_t i = 0; i < kBlockPixels; ++i)
        for (std::uint32_t j = 0; j < kBlockDigits; ++j)
          if (i >> j & 1) all[d][i] ^= column[j];
    }
    return all;
  }();
  return digits;
}

/// Number of a pixel in its block, so that every 2x2 pixels are an aligned run of four: Morton's order.
std::uint32_t place_in_block(int x, int y) {
  const auto i = static_cast<std::uint32_t>(x), j = static_cast<std::uint32_t>(y);
  return (i & 1) | (j & 1) << 1 | (i & 2) << 1 | (j & 2) << 2;
}

/// Owen scrambling of the first digits: 15 random bits tell for each whether it is flipped, by the ones before it.
std::uint32_t scramble_first_digits(std::uint32_t x, std::uint32_t bits) {
  const std::uint32_t flips = (bits & 1) | (bits >> (1 + (x & 1)) & 1) << 1 | (bits >> (3 + (x & 3)) & 1) << 2 |
                              (bits >> (7 + (x & 7)) & 1) << 3;
  return x ^ flips;
}

/// Those of the 15 bits with which 0, the digits of the first pass, becomes `target`.
constexpr std::uint32_t kBitsOfZero = 1 | 1 << 1 | 1 << 3 | 1 << 7;
std::uint32_t bits_from_zero_to(std::uint32_t target) {
  return (target & 1) | (target >> 1 & 1) << 1 | (target >> 2 & 1) << 3 | (target >> 3 & 1) << 7;
}

/// Where in the point of a pass a decision has its dimensions: the best ones, which are the first, go to what matters
/// most. At the camera ray's vertex only, and for so many lights.
struct Place {
  int first = 0, each = 0, lights = 0;
};
constexpr int kLights = 3;

constexpr std::array<Place, kDecisionCount> kPlaces = [] {
  std::array<Place, kDecisionCount> places;
  const auto place = [&](Decision d) -> Place& { return places[static_cast<std::size_t>(d)]; };
  place(Decision::Pixel) = {0, 2, 1};
  place(Decision::DensityDistance) = {2, 1, kLights};
  place(Decision::MarchOffset) = {5, 1, 1};
  place(Decision::LightPoint) = {6, 2, kLights};
  place(Decision::EquiangularDistance) = {12, 1, kLights};
  place(Decision::ShadowOffset) = {15, 1, kLights};
  place(Decision::BounceDistance) = {18, 1, 1};
  place(Decision::BounceDirection) = {19, 2, 1};
  place(Decision::LightChoice) = {21, 1, 1};
  place(Decision::BounceTechnique) = {22, 1, 1};
  place(Decision::MediumOrSurface) = {23, 1, 1};
  return places;
}();

/// Dimension of the decision in the point of the pass; -1 when it has none.
int joint_dimension(Decision decision, int bounce, int index) {
  const Place& place = kPlaces[static_cast<std::size_t>(decision)];
  return bounce == 0 && index < place.lights ? place.first + place.each * index : -1;
}

}  // namespace

Sampler::Sampler(SamplerKind kind, std::uint64_t seed, std::uint32_t pixel, std::uint32_t sample)
    : kind_(kind),
      sample_(sample),
      seed_key_(combine(0, seed)),
      pixel_key_(combine(seed_key_, pixel)),
      block_key_(mix(pixel_key_)),
      point_{} {
  if (kind != SamplerKind::Sobol) return;
  const auto& matrices = sobol_matrices();
  for (std::size_t d = 0; d < point_.size(); ++d)
    for (std::uint32_t rest = sample, j = 0; rest != 0; rest >>= 1, ++j)
      if (rest & 1) point_[d] ^= matrices[d][j];
}

Sampler Sampler::of_pixel(int x, int y, int picture_width) const {
  const auto number = [](int column, int row, int columns) {
    return static_cast<std::uint64_t>(row) * static_cast<std::uint64_t>(columns) + static_cast<std::uint64_t>(column);
  };
  Sampler other = *this;
  other.pixel_key_ = combine(seed_key_, number(x, y, picture_width));
  other.block_key_ = combine(~seed_key_, number(x / kBlockSide, y / kBlockSide, picture_width));
  other.place_ = place_in_block(x, y);
  return other;
}

std::uint64_t Sampler::dimension_key(std::uint64_t key, Decision decision, int bounce, int index) const {
  const std::uint64_t dimension = (static_cast<std::uint64_t>(decision) << 56) ^
                                  (static_cast<std::uint64_t>(static_cast<std::uint32_t>(bounce)) << 24) ^
                                  static_cast<std::uint32_t>(index);
  return combine(key, dimension);
}

/// The pixel's own scrambling, whose first digits are flipped by random bits, so that one round is enough for the
/// others; but for the place of the first pass, of which the first digits are the block's to give.
std::uint32_t Sampler::joint_bits(std::size_t dimension, std::uint32_t pixel_key, std::uint32_t block_key) const {
  constexpr std::uint32_t kFirst = (1u << kBlockDigits) - 1;
  const std::uint32_t x = point_[dimension];
  const std::uint32_t target = scramble_first_digits(block_digits()[dimension][place_], block_key);
  const std::uint32_t own = pixel_key * 0x9e3779b9u >> 16;
  const std::uint32_t bits = (own & ~kBitsOfZero) | bits_from_zero_to(target);
  return reverse_bits((laine_karras_round(x, pixel_key) & ~kFirst) | scramble_first_digits(x & kFirst, bits));
}

float Sampler::u1(Decision decision, int bounce, int index) const {
  const std::uint64_t key = dimension_key(pixel_key_, decision, bounce, index);
  if (kind_ == SamplerKind::Independent) return to_unit(static_cast<std::uint32_t>(combine(key, sample_)));
  if (const int d = joint_dimension(decision, bounce, index); d >= 0) {
    const std::uint64_t block = dimension_key(block_key_, decision, bounce, index);
    return to_unit(
        joint_bits(static_cast<std::size_t>(d), static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(block)));
  }
  return to_unit(PaddedPoint(sample_, key).x());
}

Vec2 Sampler::u2(Decision decision, int bounce, int index) const {
  const std::uint64_t key = dimension_key(pixel_key_, decision, bounce, index);
  if (kind_ == SamplerKind::Independent) {
    const std::uint64_t bits = combine(key, sample_);
    return {to_unit(static_cast<std::uint32_t>(bits)), to_unit(static_cast<std::uint32_t>(bits >> 32))};
  }
  if (const int d = joint_dimension(decision, bounce, index); d >= 0) {
    const auto x = static_cast<std::size_t>(d);
    const std::uint64_t block = dimension_key(block_key_, decision, bounce, index);
    return {to_unit(joint_bits(x, static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(block))),
            to_unit(joint_bits(x + 1, static_cast<std::uint32_t>(key >> 32), static_cast<std::uint32_t>(block >> 32)))};
  }
  const PaddedPoint p(sample_, key);
  return {to_unit(p.x()), to_unit(p.y())};
}

float Sampler::per_pixel(Decision decision) const {
  return to_unit(static_cast<std::uint32_t>(dimension_key(pixel_key_, decision, 0, 0) >> 32));
}

}  // namespace brume
