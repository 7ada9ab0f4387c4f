// Integer hashes that random numbers are made of.
#pragma once

#include <cstdint>

namespace brume {

/// A bijection of 64 bits that mixes well. Steele et al. 2014, "Fast Splittable Pseudorandom Number Generators",
/// variant 13 of Stafford's finalizers.
constexpr std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

constexpr std::uint64_t combine(std::uint64_t key, std::uint64_t value) {
  return mix(key + 0x9e3779b97f4a7c15ull * (value + 1));
}

}  // namespace brume
