#include "renderer/film/film.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "renderer/core/check.h"

namespace brume {
namespace {

double luminance(const double rgb[3]) { return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]; }  // as in vec.h

/// Factor from the sum of squared deviations to the variance of the mean.
double variance_factor(std::uint32_t count) {
  return count < 2 ? 0 : 1 / (static_cast<double>(count) * (static_cast<double>(count) - 1));
}

/// The variance of huge finite samples can exceed a float: it stays finite, at the largest one.
float to_finite_float(double value) {
  return static_cast<float>(std::min(value, static_cast<double>(std::numeric_limits<float>::max())));
}

}  // namespace

void Film::resize(int width, int height) {
  BRUME_CHECK(width, >=, 0);
  BRUME_CHECK(height, >=, 0);
  width_ = width;
  height_ = height;
  pixels_.assign(static_cast<std::size_t>(width) * height, Pixel{});
}

void Film::clear() { std::fill(pixels_.begin(), pixels_.end(), Pixel{}); }

void Film::clear_row(int y) {
  const auto row = pixels_.begin() + static_cast<std::ptrdiff_t>(y) * width_;
  std::fill(row, row + width_, Pixel{});
}

bool Film::add_sample(int x, int y, Color sample) {
  BRUME_DCHECK(x, >=, 0);
  BRUME_DCHECK(x, <, width_);
  BRUME_DCHECK(y, >=, 0);
  BRUME_DCHECK(y, <, height_);
  if (!is_finite(sample)) return false;

  Pixel& p = pixels_[static_cast<std::size_t>(y) * width_ + x];
  p.count += 1;
  const double inverse_count = 1.0 / p.count;
  // delta is the deviation from the mean before this sample, delta (1 - 1/n) the one after; their product goes to M2.
  double delta[3];
  for (int c = 0; c < 3; ++c) {
    delta[c] = sample[c] - p.mean[c];
    p.mean[c] += delta[c] * inverse_count;
    p.m2[c] += delta[c] * delta[c] * (1 - inverse_count);
  }
  return true;
}

bool Film::has_twin(int x, int y) {
  constexpr std::uint32_t kBlock = 8;
  const std::uint32_t block =
      (static_cast<std::uint32_t>(x) / kBlock) * 0x9E3779B1u ^ (static_cast<std::uint32_t>(y) / kBlock) * 0x85EBCA77u;
  const std::uint32_t place = (block ^ block >> 15) * 0x2C1B3C6Du >> 26;  // top bits of a product: the best mixed
  return place == static_cast<std::uint32_t>(y) % kBlock * kBlock + static_cast<std::uint32_t>(x) % kBlock;
}

bool Film::add_twin_sample(int x, int y, Color sample) {
  BRUME_DCHECK(has_twin(x, y), ==, true);
  if (!is_finite(sample)) return false;
  Pixel& p = pixels_[static_cast<std::size_t>(y) * width_ + x];
  p.twin_count += 1;
  p.twin_luminance += (static_cast<double>(brume::luminance(sample)) - p.twin_luminance) / p.twin_count;
  return true;
}

Color Film::mean(int x, int y) const {
  const Pixel& p = pixel(x, y);
  return {static_cast<float>(p.mean[0]), static_cast<float>(p.mean[1]), static_cast<float>(p.mean[2])};
}

Color Film::variance(int x, int y) const {
  const Pixel& p = pixel(x, y);
  const double factor = variance_factor(p.count);
  return {to_finite_float(p.m2[0] * factor), to_finite_float(p.m2[1] * factor), to_finite_float(p.m2[2] * factor)};
}

void Film::mean_image(Image& image) const {
  image.width = width_;
  image.height = height_;
  image.pixels.resize(pixels_.size());
  for (int y = 0; y < height_; ++y) mean_row(y, image);
}

void Film::mean_row(int y, Image& image) const {
  for (int x = 0; x < width_; ++x) image.at(x, y) = mean(x, y);
}

Image Film::mean_image() const {
  Image image;
  mean_image(image);
  return image;
}

Image Film::variance_image() const {
  Image image(width_, height_);
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) image.at(x, y) = variance(x, y);
  return image;
}

double Film::mean_variance() const { return noise_sums().mean_variance(); }

double Film::NoiseSums::mean_variance() const { return pixels == 0 ? 0 : variance / (3 * static_cast<double>(pixels)); }

Film::NoiseSums Film::noise_of_row(int y) const {
  NoiseSums sums;
  for (int x = 0; x < width_; ++x) {
    const Pixel& p = pixel(x, y);
    if (p.count == 0) continue;
    const double own = luminance(p.mean);
    sums.luminance += own;
    sums.variance += (p.m2[0] + p.m2[1] + p.m2[2]) * variance_factor(p.count);
    ++sums.pixels;
    if (p.twin_count == 0) continue;
    sums.difference += std::abs(own - p.twin_luminance);
    ++sums.pairs;
  }
  return sums;
}

void Film::NoiseSums::add(const NoiseSums& other) {
  luminance += other.luminance, difference += other.difference, variance += other.variance;
  pixels += other.pixels, pairs += other.pairs;
}

double Film::NoiseSums::estimate() const {
  if (pairs == 0 || !(luminance > 0)) return 0;
  const double half_root_pi = std::sqrt(std::numbers::pi) / 2;
  return half_root_pi * difference / static_cast<double>(pairs) / (luminance / static_cast<double>(pixels));
}

Film::NoiseSums Film::noise_sums() const {
  NoiseSums sums;
  for (int y = 0; y < height_; ++y) sums.add(noise_of_row(y));
  return sums;
}

double Film::noise_estimate() const { return noise_sums().estimate(); }

}  // namespace brume
