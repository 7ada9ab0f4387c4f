#include "renderer/sampling/sampler.h"

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

/// Owen scrambling of a bit-reversed number: every bit is flipped by a hash of the bits below it.
/// Laine & Karras 2011, "Stratified Sampling for Stochastic Transparency", section 3.1; this hash by Vegdahl 2021,
/// "Building a Better LK Hash". Two rounds: after one, some pairs of dimensions are correlated.
std::uint32_t laine_karras(std::uint32_t x, std::uint32_t seed) {
  for (int round = 0; round < 2; ++round, seed *= 0x9e3779b9u) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
  }
  return x;
}

std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
  return reverse_bits(laine_karras(reverse_bits(x), seed));
}

/// Second dimension of the Sobol' sequence (direction numbers of the polynomial x + 1).
std::uint32_t sobol_second(std::uint32_t index) {
  std::uint32_t result = 0;
  for (std::uint32_t v = 0x80000000u; index != 0; index >>= 1, v ^= v >> 1)
    if (index & 1) result ^= v;
  return result;
}

struct Bits2 {
  std::uint32_t x, y;
};

/// Point number `index` of a (0,2)-sequence whose order and digits are scrambled by `key`: Burley 2020, section 4
/// (padding: every pair of dimensions has its own shuffle).
Bits2 scrambled_sobol(std::uint32_t index, std::uint64_t key) {
  const auto shuffle = static_cast<std::uint32_t>(key);
  const std::uint64_t more = mix(key);
  const std::uint32_t i = owen_scramble(index, shuffle);
  // The first Sobol' dimension is the bit-reversed index, so one of the two reversals cancels.
  const std::uint32_t x = reverse_bits(laine_karras(i, static_cast<std::uint32_t>(more)));
  return {x, owen_scramble(sobol_second(i), static_cast<std::uint32_t>(more >> 32))};
}

}  // namespace

std::uint64_t Sampler::dimension_key(Decision decision, int bounce, int index) const {
  const std::uint64_t dimension = (static_cast<std::uint64_t>(decision) << 56) ^
                                  (static_cast<std::uint64_t>(static_cast<std::uint32_t>(bounce)) << 24) ^
                                  static_cast<std::uint32_t>(index);
  return combine(combine(combine(0, seed_), pixel_), dimension);
}

float Sampler::u1(Decision decision, int bounce, int index) const { return u2(decision, bounce, index).x; }

Vec2 Sampler::u2(Decision decision, int bounce, int index) const {
  const std::uint64_t key = dimension_key(decision, bounce, index);
  if (kind_ == SamplerKind::Sobol) {
    const Bits2 p = scrambled_sobol(sample_, key);
    return {to_unit(p.x), to_unit(p.y)};
  }
  const std::uint64_t bits = combine(key, sample_);
  return {to_unit(static_cast<std::uint32_t>(bits)), to_unit(static_cast<std::uint32_t>(bits >> 32))};
}

float Sampler::per_pixel(Decision decision) const {
  return to_unit(static_cast<std::uint32_t>(dimension_key(decision, 0, 0) >> 32));
}

}  // namespace brume
