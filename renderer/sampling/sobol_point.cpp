#include "renderer/sampling/sobol_point.h"

#include <boost/random/sobol.hpp>

namespace brume {
namespace {

using Matrix = std::array<std::uint32_t, 32>;  // column j: what bit j of the index adds to the digits

/// The matrices of the first dimensions, with the direction numbers that Boost holds.
const std::array<Matrix, kJointDimensions>& sobol_matrices() {
  static const auto matrices = [] {
    const auto reversed = [](std::uint32_t v) {
      std::uint32_t r = 0;
      for (int bit = 0; bit < 32; ++bit) r |= (v >> bit & 1) << (31 - bit);
      return r;
    };
    std::array<Matrix, kJointDimensions> all;
    boost::random::sobol_engine<std::uint32_t, 32> engine(all.size());
    for (unsigned j = 0; j < 32; ++j) {
      // Boost runs through the points in the order of Gray's code and leaves out the first, which is 0: this is the one
      // whose index has bit j only.
      engine.seed((std::uint64_t{1} << (j + 1)) - 2);
      for (Matrix& matrix : all) matrix[j] = reversed(engine());
    }
    return all;
  }();
  return matrices;
}

}  // namespace

JointArray<std::uint32_t> sobol_digits(std::uint32_t index) {
  JointArray<std::uint32_t> digits{};
  const auto& matrices = sobol_matrices();
  for (std::size_t d = 0; d < matrices.size(); ++d)
    for (std::uint32_t rest = index, j = 0; rest != 0; rest >>= 1, ++j)
      if (rest & 1) digits[d] ^= matrices[d][j];
  return digits;
}

}  // namespace brume
