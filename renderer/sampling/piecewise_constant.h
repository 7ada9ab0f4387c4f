// Sampling in proportion to tabulated values.
#pragma once

#include <vector>

#include "renderer/core/vec.h"

namespace brume {

/// A density on [0,1)^2 that is constant in each of width x height cells, in proportion to given weights.
/// Rows by their sums first, then a cell of the row: two binary searches.
class PiecewiseConstant2D {
 public:
  PiecewiseConstant2D() = default;
  /// @param weights  row by row, width * height of them, each finite and >= 0.  All zero: uniform.
  PiecewiseConstant2D(int width, int height, const std::vector<float>& weights);

  struct Sample {
    Vec2 position;
    float pdf;  ///< per unit area of [0,1)^2
  };
  /// @param u  in [0,1)^2
  Sample sample(Vec2 u) const;
  float pdf(Vec2 position) const;

 private:
  int width_ = 0, height_ = 0;
  std::vector<float> rows_;   // [height + 1] distribution function of the rows
  std::vector<float> cells_;  // [height][width + 1] of the cells in their rows
};

}  // namespace brume
