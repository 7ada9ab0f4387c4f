#include "renderer/analysis/chart.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace brume {
namespace {

using Vector = std::array<double, 3>;
using Matrix = std::array<Vector, 3>;

Vector times(const Matrix& m, const Vector& v) {
  Vector result{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) result[i] += m[i][j] * v[j];
  return result;
}

Vector linear(Rgb color) {
  Vector result{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double v = color[i] / 255.0;
    result[i] = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  }
  return result;
}

/// Ottosson 2020, "A perceptual color space for image processing".
Vector oklab(const Vector& rgb) {
  constexpr Matrix kCones{{{0.4122214708, 0.5363325363, 0.0514459929},
                           {0.2119034982, 0.6806995451, 0.1073969566},
                           {0.0883024619, 0.2817188376, 0.6299787005}}};
  constexpr Matrix kLab{{{0.2104542553, 0.7936177850, -0.0040720468},
                         {1.9779984951, -2.4285922050, 0.4505937099},
                         {0.0259040371, 0.7827717662, -0.8086757660}}};
  Vector cones = times(kCones, rgb);
  for (double& c : cones) c = std::cbrt(c);
  return times(kLab, cones);
}

/// Vision, normal and with severity 1 of Machado, Oliveira & Fernandes 2009, "A Physiologically-based Model for
/// Simulation of Color Vision Deficiency", in linear RGB.
constexpr std::array<Matrix, 4> kVisions{
    {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
     {{{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}},
     {{{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}},
     {{{1.255528, -0.076749, -0.178779}, {-0.078411, 0.930809, 0.147602}, {0.004733, 0.691367, 0.303900}}}}};

double luminance(Rgb color) {
  const Vector v = linear(color);
  return 0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2];
}

TEST(SeriesColor, AllEightAreToldApartByAnyVision) {
  for (const Matrix& vision : kVisions)
    for (std::size_t i = 0; i < 8; ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const Vector a = oklab(times(vision, linear(series_color(i)))),
                     b = oklab(times(vision, linear(series_color(j))));
        // 0.02 is just noticeable for large patches; the printed palette of Okabe & Ito has 0.076 at its closest.
        EXPECT_GT(std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]), 0.11) << i << " and " << j;
      }
}

TEST(SeriesColor, EachIsReadOnWhiteAndOnNearBlack) {
  for (std::size_t i = 0; i < 8; ++i) {
    // The contrast ratio of WCAG 2.1.
    EXPECT_GT(1.05 / (luminance(series_color(i)) + 0.05), 2.1) << i;
    EXPECT_GT((luminance(series_color(i)) + 0.05) / (luminance({27, 27, 29}) + 0.05), 2.6) << i;
  }
}

TEST(SeriesColor, ComesAgainAfterEight) {
  std::set<Rgb> colors;
  for (std::size_t i = 0; i < 8; ++i) colors.insert(series_color(i));
  EXPECT_EQ(colors.size(), 8u);
  EXPECT_EQ(series_color(8), series_color(0));
  EXPECT_EQ(series_color(19), series_color(3));
}

}  // namespace
}  // namespace brume
