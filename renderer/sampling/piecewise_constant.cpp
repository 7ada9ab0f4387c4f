#include "renderer/sampling/piecewise_constant.h"

#include "renderer/core/check.h"

namespace brume {
namespace {

/// Writes the distribution function of n weights to cdf[0..n]; returns their sum.
template <class T> double accumulate(const T* weights, int n, float* cdf) {
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += static_cast<double>(weights[i]);
  double running = 0;
  for (int i = 0; i <= n; ++i) {
    cdf[i] = static_cast<float>(sum > 0 ? running / sum : static_cast<double>(i) / n);
    if (i < n) running += static_cast<double>(weights[i]);
  }
  cdf[n] = 1;
  return sum;
}

/// The inverse of u.
struct Inverse {
  int cell;
  float position;  // in [0,1) of the whole range, and in the cell
  float density;
};

Inverse invert(const float* cdf, int n, float u) {
  const float* above = std::upper_bound(cdf, cdf + n + 1, u);
  const int cell = std::clamp(static_cast<int>(above - cdf) - 1, 0, n - 1);
  const float share = cdf[cell + 1] - cdf[cell], size = static_cast<float>(n);
  const float inside = share > 0 ? (u - cdf[cell]) / share : 0.5f;
  float position = (static_cast<float>(cell) + inside) / size;
  // Rounding may have carried it over the cell's edge.
  while (static_cast<int>(position * size) > cell) position = std::nextafter(position, 0.0f);
  while (static_cast<int>(position * size) < cell) position = std::nextafter(position, 1.0f);
  return {cell, position, share * size};
}

}  // namespace

PiecewiseConstant2D::PiecewiseConstant2D(int width, int height, const std::vector<float>& weights)
    : width_(width), height_(height) {
  BRUME_CHECK(weights.size(), ==, static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
  cells_.resize(h * (w + 1));
  rows_.resize(h + 1);
  std::vector<double> sums(h);  // of finite floats, which may add up to more than a float holds
  for (std::size_t y = 0; y < h; ++y) sums[y] = accumulate(&weights[y * w], width, &cells_[y * (w + 1)]);
  accumulate(sums.data(), height, rows_.data());
}

PiecewiseConstant2D::Sample PiecewiseConstant2D::sample(Vec2 u) const {
  const Inverse row = invert(rows_.data(), height_, u.y);
  const float* cells = &cells_[static_cast<std::size_t>(row.cell) * static_cast<std::size_t>(width_ + 1)];
  const Inverse cell = invert(cells, width_, u.x);
  return {{cell.position, row.position}, row.density * cell.density};
}

float PiecewiseConstant2D::pdf(Vec2 position) const {
  const int x = std::clamp(static_cast<int>(position.x * static_cast<float>(width_)), 0, width_ - 1);
  const int y = std::clamp(static_cast<int>(position.y * static_cast<float>(height_)), 0, height_ - 1);
  const float* cells =
      &cells_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_ + 1) + static_cast<std::size_t>(x)];
  const float row = rows_[static_cast<std::size_t>(y) + 1] - rows_[static_cast<std::size_t>(y)];
  return row * static_cast<float>(height_) * (cells[1] - cells[0]) * static_cast<float>(width_);
}

}  // namespace brume
