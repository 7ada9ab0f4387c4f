#include "renderer/analysis/metrics.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "renderer/analysis/comparable.h"

namespace brume {
namespace {

struct Rectangle {
  int x_begin, y_begin, x_end, y_end;
};

Rectangle whole(const Image& image) { return {0, 0, image.width, image.height}; }

/// Mean over the values within `area` of term(t, r), both double.
template <class Term> double mean_over(const Image& test, const Image& reference, Rectangle area, const Term& term) {
  double sum = 0;
  for (int y = area.y_begin; y < area.y_end; ++y)
    for (int x = area.x_begin; x < area.x_end; ++x) {
      const Color t = test.at(x, y), r = reference.at(x, y);
      for (int c = 0; c < 3; ++c) sum += term(static_cast<double>(t[c]), static_cast<double>(r[c]));
    }
  return sum / (3.0 * (area.x_end - area.x_begin) * (area.y_end - area.y_begin));
}

double squared_error(double t, double r) { return (t - r) * (t - r); }

}  // namespace

Result<double> rmse(const Image& test, const Image& reference) {
  if (std::optional<Error> error = not_comparable(test, reference)) return *error;
  return std::sqrt(mean_over(test, reference, whole(test), squared_error));
}

Result<double> relative_mse(const Image& test, const Image& reference, double epsilon) {
  if (!(epsilon > 0)) return bad_input("found an epsilon of " + std::to_string(epsilon) + ", expected more than 0");
  if (std::optional<Error> error = not_comparable(test, reference)) return *error;
  return mean_over(test, reference, whole(test),
                   [&](double t, double r) { return squared_error(t, r) / (r * r + epsilon); });
}

Result<double> mean_bias(const Image& test, const Image& reference) {
  if (std::optional<Error> error = not_comparable(test, reference)) return *error;
  return mean_over(test, reference, whole(test), [](double t, double r) { return t - r; });
}

Result<double> relative_mean_bias(const Image& test, const Image& reference) {
  const Result<double> bias = mean_bias(test, reference);
  if (!bias) return bias;
  const double brightness = mean_over(test, reference, whole(test), [](double, double r) { return r; });
  if (brightness == 0) return bad_input("found a black reference image, expected light to be relative to");
  return *bias / brightness;
}

Result<double> median_of_tiles(const Image& test, const Image& reference, int tile_size) {
  if (tile_size < 1) return bad_input("found a tile size of " + std::to_string(tile_size) + ", expected at least 1");
  if (std::optional<Error> error = not_comparable(test, reference)) return *error;
  const int side = std::min(tile_size, std::max(test.width, test.height));  // no overflow in x + side
  std::vector<double> errors;
  for (int y = 0; y < test.height; y += side)
    for (int x = 0; x < test.width; x += side) {
      const Rectangle tile{x, y, std::min(x + side, test.width), std::min(y + side, test.height)};
      const double light =
          mean_over(test, reference, tile, [](double t, double r) { return std::abs(t) + std::abs(r); });
      if (light > 0) errors.push_back(mean_over(test, reference, tile, squared_error));
    }
  if (errors.empty()) return 0.0;
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  double median = *middle;
  if (errors.size() % 2 == 0) median = (median + *std::max_element(errors.begin(), middle)) / 2;
  return std::sqrt(median);
}

Result<Errors> errors_of(const Image& test, const Image& reference) {
  if (std::optional<Error> error = not_comparable(test, reference)) return *error;
  Errors e;
  e.rmse = *rmse(test, reference);
  e.relative_mse = *relative_mse(test, reference);
  e.mean_bias = *mean_bias(test, reference);
  if (const Result<double> relative = relative_mean_bias(test, reference)) e.relative_mean_bias = *relative;
  e.median_of_tiles = *median_of_tiles(test, reference);
  return e;
}

}  // namespace brume
