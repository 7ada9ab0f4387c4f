// Scrambling of a pass's Sobol' point for each pixel.
#pragma once

#include "renderer/sampling/sobol_point.h"

namespace brume {

/// Whose random numbers scramble the point.
struct JointKeys {
  std::uint64_t pixel = 0;
  std::uint64_t block = 0;  ///< of pixels
  std::uint32_t place = 0;  ///< of the pixel in its block
};

/// The scrambled point, every coordinate in [0, 1): each digit is flipped by what the digits before it and the pixel's
/// key tell (Owen 1995); in the first pass of all, where all digits are 0, the first ones are the block's to give. All
/// coordinates at SIMD width; the same bits at each SIMD level.
void scramble(const JointArray<std::uint32_t>& digits, const JointKeys& keys, JointArray<float>& numbers);

}  // namespace brume
