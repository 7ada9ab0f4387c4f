// Points of the Sobol' sequence.
#pragma once

#include <array>
#include <cstdint>

namespace brume {

inline constexpr int kJointDimensions = 24;

/// One for each dimension, up to a multiple of the widest vector.
template <class T> using JointArray = std::array<T, 32>;

/// Point number `index` of the Sobol' sequence, before it is scrambled. The digits of every coordinate are in reverse:
/// the first one is the lowest bit. Joe & Kuo 2008, "Constructing Sobol' Sequences with Better Two-Dimensional
/// Projections".
JointArray<std::uint32_t> sobol_digits(std::uint32_t index);

}  // namespace brume
