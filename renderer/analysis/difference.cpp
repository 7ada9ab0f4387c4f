#include "renderer/analysis/difference.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "renderer/analysis/flip.h"

namespace brume {
namespace {

float value_of(float t, float r, DifferenceKind kind) {
  constexpr float kDark = 0.01f;  // radiance at which a relative error begins to count less
  switch (kind) {
    case DifferenceKind::Signed:
      return t - r;
    case DifferenceKind::Absolute:
      return std::abs(t - r);
    case DifferenceKind::Relative:
      return std::abs(t - r) / (std::abs(r) + kDark);
    case DifferenceKind::Squared:
      return (t - r) * (t - r);
  }
  return 0;
}

/// The next of 1, 2, 5, 10, 20, ... and 0.5, 0.2, 0.1, ...
double round_up(double value) {
  const double decade = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0})
    if (step * decade >= value * (1 - 1e-6)) return step * decade;
  return 10 * decade;
}

double range_of(std::vector<float> sizes) {
  for (float& v : sizes) v = std::isfinite(v) ? std::abs(v) : 0;
  const auto most = sizes.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(sizes.size() - 1));
  std::nth_element(sizes.begin(), most, sizes.end());
  double range = static_cast<double>(*most);
  if (!(range > 0)) range = static_cast<double>(*std::max_element(most, sizes.end()));
  return range > 0 ? round_up(range) : 1;
}

}  // namespace

std::array<std::uint8_t, 3> difference_color(double fraction, DifferenceKind kind) {
  if (kind != DifferenceKind::Signed) return heat_color(static_cast<float>(fraction));
  // From black to the two colours that all eyes tell apart, and on to white where there is most.
  const double size = std::clamp(std::abs(fraction), 0.0, 1.0);
  const std::array<double, 3> hue = fraction < 0 ? std::array{60.0, 130.0, 246.0} : std::array{240.0, 90.0, 40.0};
  std::array<std::uint8_t, 3> color{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double v = size < 0.75 ? hue[c] * size / 0.75 : hue[c] + (255 - hue[c]) * (size - 0.75) / 0.25 * 0.7;
    color[c] = static_cast<std::uint8_t>(v + 0.5);
  }
  return color;
}

Result<DifferenceMap> difference_map(const Image& test, const Image& reference, DifferenceKind kind, double range) {
  if (test.width != reference.width || test.height != reference.height || test.empty())
    return bad_input("found pictures of " + std::to_string(test.width) + " x " + std::to_string(test.height) + " and " +
                     std::to_string(reference.width) + " x " + std::to_string(reference.height) +
                     " pixels, expected the same size to compare");
  std::vector<float> values(test.pixels.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = value_of(luminance(test.pixels[i]), luminance(reference.pixels[i]), kind);
  DifferenceMap map{Image8(test.width, test.height, 4), range > 0 ? range : range_of(values)};

  // A value has one of some hundred colours; looked up, because there are many values.
  constexpr int kColors = 512;
  std::vector<std::array<std::uint8_t, 3>> colors;
  for (int i = 0; i <= kColors; ++i) colors.push_back(difference_color(2.0 * i / kColors - 1, kind));
  const float scale = static_cast<float>(1 / map.range);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float fraction = std::isfinite(values[i]) ? std::clamp(values[i] * scale, -1.0f, 1.0f) : 1;
    const auto& color = colors[static_cast<std::size_t>((fraction + 1) * (kColors / 2) + 0.5f)];
    std::copy(color.begin(), color.end(), map.image.bytes.begin() + static_cast<std::ptrdiff_t>(4 * i));
    map.image.bytes[4 * i + 3] = 255;
  }
  return map;
}

}  // namespace brume
