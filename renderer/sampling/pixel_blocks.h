// Blocks of pixels that share out their first random numbers.
#pragma once

#include <array>
#include <cstdint>

#include "renderer/sampling/hash.h"
#include "renderer/sampling/sobol_point.h"

namespace brume {

inline constexpr int kBlockSide = 4, kBlockPixels = kBlockSide * kBlockSide;

/// Number of a pixel in its block, so that every 2x2 pixels are an aligned run of four: Morton's order.
inline std::uint32_t place_in_block(int x, int y) {
  const auto i = static_cast<std::uint32_t>(x), j = static_cast<std::uint32_t>(y);
  return (i & 1) | (j & 1) << 1 | (i & 2) << 1 | (j & 2) << 2;
}

/// The first digits, in reverse, of the number of each pixel in each dimension: linear maps of the pixel's place, so
/// that a block hits every sixteenth of [0, 1) once and each of its quarters every quarter; otherwise random.
inline constexpr std::array<JointArray<std::uint32_t>, kBlockPixels> kBlockDigits = [] {
  std::array<JointArray<std::uint32_t>, kBlockPixels> digits{};
  for (std::size_t d = 0; d < kJointDimensions; ++d) {
    // Columns of a 4x4 matrix modulo 2 of which the upper left quarter and the lower right one are invertible, the
    // lower left one is 0 and the upper right one free.
    const std::uint64_t bits = mix(0x6272756d65ull + d);
    constexpr std::uint32_t kInvertible[][2] = {{1, 2}, {2, 1}, {1, 3}, {3, 1}, {2, 3}, {3, 2}};
    const auto& upper = kInvertible[bits % 6];
    const auto& lower = kInvertible[bits / 6 % 6];
    const std::uint32_t column[] = {upper[0], upper[1], lower[0] << 2 | static_cast<std::uint32_t>(bits >> 32 & 3),
                                    lower[1] << 2 | static_cast<std::uint32_t>(bits >> 34 & 3)};
    for (std::uint32_t place = 0; place < kBlockPixels; ++place)
      for (std::uint32_t j = 0; j < 4; ++j)
        if (place >> j & 1) digits[place][d] ^= column[j];
  }
  return digits;
}();

/// What tells the dimensions' scramblings apart.
inline constexpr JointArray<std::uint32_t> kDimensionSalts = [] {
  JointArray<std::uint32_t> salts{};
  for (std::size_t d = 0; d < kJointDimensions; ++d) salts[d] = static_cast<std::uint32_t>(combine(0, d));
  return salts;
}();

}  // namespace brume
