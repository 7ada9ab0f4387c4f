#include "renderer/analysis/hdr_flip.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "renderer/analysis/comparable.h"

namespace brume {
namespace {

// ---- Tone mapper ---------------------------------------------------------------------------------------------------

// Narkowicz 2015, a to e; k0 = a, k1 = b, k3 = c, k4 = d, k5 = e of the paper, with one factor for each power of x.
constexpr double kPreExposure = 0.6;
constexpr double kK0 = 2.51 * kPreExposure * kPreExposure, kK1 = 0.03 * kPreExposure;
constexpr double kK3 = 2.43 * kPreExposure * kPreExposure, kK4 = 0.59 * kPreExposure, kK5 = 0.14;

/// @param x  at least 0.    @return 0 for 0, grows towards 1.03.
double aces(double x) { return x * (kK0 * x + kK1) / (x * (kK3 * x + kK4) + kK5); }

/// Solves aces(x) = y, (k0 - y k3) x^2 + (k1 - y k4) x - y k5 = 0. The first coefficient is positive and the last not,
/// so one root is at least 0.
/// @param y  [0, 1].
double inverse_aces(double y) {
  const double a = kK0 - y * kK3, b = kK1 - y * kK4, c = -y * kK5;
  return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

/// What a monitor shows of `image`, once flip_linear() has clamped it. In double: 2^c x may be beyond a float.
Image tone_mapped(const Image& image, double exposure) {
  const double scale = std::exp2(exposure);
  Image result(image.width, image.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double x = scale * std::max(0.0, static_cast<double>(image.pixels[i][c]));
      result.pixels[i][c] = static_cast<float>(aces(x));
    }
  return result;
}

// ---- Exposures -----------------------------------------------------------------------------------------------------

struct Range {
  double start, stop;  ///< stops
};

/// @param sorted  not empty.    @return the mean of the middle two of an even number.
double median(std::span<const double> sorted) {
  return 0.5 * (sorted[(sorted.size() - 1) / 2] + sorted[sorted.size() / 2]);
}

/// None of a black image.
std::optional<Range> range_of(const Image& image) {
  std::vector<double> y;  // luminance
  y.reserve(image.pixels.size());
  for (const Color& p : image.pixels) {
    const auto light = [](float x) { return std::max(0.0, static_cast<double>(x)); };
    y.push_back(0.2126 * light(p.r) + 0.7152 * light(p.g) + 0.0722 * light(p.b));
  }
  std::sort(y.begin(), y.end());
  const std::span<const double> lit(std::upper_bound(y.begin(), y.end(), 0.0), y.end());
  if (lit.empty()) return {};
  const double y_median = median(y) > 0 ? median(y) : median(lit);
  const double x_t = inverse_aces(0.85);
  return Range{std::log2(x_t / y.back()), std::log2(x_t / y_median)};
}

Range automatic_range(const Image& test, const Image& reference) {
  if (const auto range = range_of(reference)) return *range;
  return range_of(test).value_or(Range{0, 0});
}

int exposure_count(double stops) { return std::max(2, static_cast<int>(std::ceil(stops - 1e-4))); }

}  // namespace

Result<HdrFlipResult> hdr_flip(const Image& test, const Image& reference, const HdrFlipSettings& settings) {
  for (const auto& exposure : {settings.start_exposure, settings.stop_exposure})
    if (exposure && !(*exposure >= -200 && *exposure <= 200))
      return bad_input("found an exposure of " + std::to_string(*exposure) + " stops, expected -200 to 200");
  if (std::optional<Error> error = not_comparable(test, reference)) return *error;

  HdrFlipResult result;
  const Range automatic = automatic_range(test, reference);
  result.start_exposure = settings.start_exposure.value_or(static_cast<float>(automatic.start));
  result.stop_exposure = settings.stop_exposure.value_or(static_cast<float>(automatic.stop));
  // As floats, so that the range in the result gives the same pictures when it is set.
  const double start = result.start_exposure, stop = result.stop_exposure;
  if ((settings.start_exposure || settings.stop_exposure) && start >= stop)
    return bad_input("found exposures from " + std::to_string(result.start_exposure) + " to " +
                     std::to_string(result.stop_exposure) +
                     " stops, expected the start below the stop (one that is not set comes from the reference)");

  result.exposures = exposure_count(stop - start);
  for (int i = 0; i < result.exposures; ++i) {
    const double exposure = start + (stop - start) * i / (result.exposures - 1);
    auto seen = flip_linear(tone_mapped(test, exposure), tone_mapped(reference, exposure), settings.ldr);
    if (!seen) return seen.error();
    if (i == 0) {
      result.flip = *std::move(seen);
      continue;
    }
    for (std::size_t p = 0; p < seen->error.size(); ++p)
      result.flip.error[p] = std::max(result.flip.error[p], seen->error[p]);
  }
  double sum = 0;
  for (const float error : result.flip.error) sum += error;
  result.flip.mean = sum / static_cast<double>(result.flip.error.size());
  return result;
}

}  // namespace brume
