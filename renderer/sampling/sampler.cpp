#include "renderer/sampling/sampler.h"

#include <bit>

#include "renderer/sampling/hash.h"
#include "renderer/sampling/pixel_blocks.h"

namespace brume {
namespace {

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

std::uint64_t pixel_number(int column, int row, int columns) {
  return static_cast<std::uint64_t>(row) * static_cast<std::uint64_t>(columns) + static_cast<std::uint64_t>(column);
}

}  // namespace

SamplerPass::SamplerPass(SamplerKind of_kind, std::uint64_t seed, std::uint32_t number)
    : kind(of_kind), sample(number), seed_key(combine(0, seed)) {
  if (kind == SamplerKind::Sobol) digits = sobol_digits(sample);
}

Sampler::Sampler(const SamplerPass& pass, const JointKeys& keys)
    : kind_(pass.kind), sample_(pass.sample), pixel_key_(keys.pixel) {
  if (kind_ == SamplerKind::Sobol) scramble(pass.digits, keys, joint_);
}

Sampler::Sampler(const SamplerPass& pass, int x, int y, int picture_width)
    : Sampler(pass, {.pixel = combine(pass.seed_key, pixel_number(x, y, picture_width)),
                     .block = combine(~pass.seed_key, pixel_number(x / kBlockSide, y / kBlockSide, picture_width)),
                     .place = place_in_block(x, y)}) {}

Sampler::Sampler(SamplerKind kind, std::uint64_t seed, std::uint32_t pixel, std::uint32_t sample)
    : Sampler(SamplerPass(kind, seed, sample),
              {.pixel = combine(combine(0, seed), pixel), .block = mix(combine(combine(0, seed), pixel))}) {}

std::uint64_t Sampler::key_of(Decision decision, int bounce, int index) const {
  const std::uint64_t dimension = (static_cast<std::uint64_t>(decision) << 56) ^
                                  (static_cast<std::uint64_t>(static_cast<std::uint32_t>(bounce)) << 24) ^
                                  static_cast<std::uint32_t>(index);
  return combine(pixel_key_, dimension);
}

float Sampler::u1(Decision decision, int bounce, int index) const {
  if (kind_ == SamplerKind::Independent)
    return to_unit(static_cast<std::uint32_t>(combine(key_of(decision, bounce, index), sample_)));
  if (const int d = joint_dimension(decision, bounce, index); d >= 0) return joint_[static_cast<std::size_t>(d)];
  return to_unit(PaddedPoint(sample_, key_of(decision, bounce, index)).x());
}

Vec2 Sampler::u2(Decision decision, int bounce, int index) const {
  if (kind_ == SamplerKind::Independent) {
    const std::uint64_t bits = combine(key_of(decision, bounce, index), sample_);
    return {to_unit(static_cast<std::uint32_t>(bits)), to_unit(static_cast<std::uint32_t>(bits >> 32))};
  }
  if (const int d = joint_dimension(decision, bounce, index); d >= 0)
    return {joint_[static_cast<std::size_t>(d)], joint_[static_cast<std::size_t>(d) + 1]};
  const PaddedPoint p(sample_, key_of(decision, bounce, index));
  return {to_unit(p.x()), to_unit(p.y())};
}

float Sampler::per_pixel(Decision decision) const {
  return to_unit(static_cast<std::uint32_t>(key_of(decision, 0, 0) >> 32));
}

}  // namespace brume
