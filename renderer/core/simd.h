// Which vector instructions the kernels use: chosen at run time, nameable and forceable.
#pragma once

#include <string>
#include <vector>

#include "renderer/core/error.h"

namespace brume {

/// Floats in the widest vector.
inline constexpr int kWidestVector = 16;

/// `n` rounded up to what the widest vectors hold.
constexpr std::size_t whole_vectors(int n) {
  return static_cast<std::size_t>((n + kWidestVector - 1) / kWidestVector * kWidestVector);
}

/// A value for each lane of the widest vectors, which may be more than are in use.
template <class T> struct alignas(sizeof(T) * kWidestVector) LaneArray {
  T v[kWidestVector];

  const T& operator[](int lane) const { return v[lane]; }
  T& operator[](int lane) { return v[lane]; }
};

/// The levels this processor can run and this program holds, best first, e.g. {"avx3", "avx2", "sse4", "ssse3",
/// "scalar"}: Highway's target names in lower case ("avx3" is AVX-512; the last one is plain C++ and always there).
/// Not narrowed by force_simd_level().
std::vector<std::string> simd_levels();

/// The level in use: the best one unless another was forced.
std::string simd_level();

/// Makes every kernel use level `name` (any case; "avx512" means "avx3", "sse2" the plain one) or, with "auto" or "",
/// the best one again. An unknown or unsupported name is an error that lists the valid ones, and changes nothing.
/// Acts on the whole process, for Highway keeps one choice per process: call it at startup or between test cases, not
/// while a kernel may be running. The library never reads the environment; the application passes BRUME_SIMD here.
Result<void> force_simd_level(const std::string& name);

}  // namespace brume
