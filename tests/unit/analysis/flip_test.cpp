#include "renderer/analysis/flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace brume {
namespace {

// A second implementation, straight from the equations of Andersson et al. 2020: double, two-dimensional convolutions
// as printed, nothing separable, no tricks. Slow, so it judges small images.
namespace slow {

constexpr double kPi = 3.14159265358979323846;
using Vector = std::array<double, 3>;

double linear(int code) {
  const double v = code / 255.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

// IEC 61966-2-1 with more digits; white is the sum of each row.
constexpr double kXyz[3][3] = {{0.4123907993, 0.3575843394, 0.1804807884},
                               {0.2126390059, 0.7151686788, 0.0721923154},
                               {0.0193308187, 0.1191947798, 0.9505321522}};

Vector relative_xyz(const Vector& rgb) {
  Vector result{};
  for (std::size_t i = 0; i < 3; ++i) {
    double white = 0;
    for (std::size_t j = 0; j < 3; ++j) result[i] += kXyz[i][j] * rgb[j], white += kXyz[i][j];
    result[i] /= white;
  }
  return result;
}

/// Solves relative_xyz(rgb) = xyz by Cramer's rule.
Vector rgb_of(const Vector& xyz) {
  double m[3][3];
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) m[i][j] = kXyz[i][j] / (kXyz[i][0] + kXyz[i][1] + kXyz[i][2]);
  const auto determinant = [](const double(&a)[3][3]) {
    return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
           a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
  };
  Vector rgb{};
  for (std::size_t column = 0; column < 3; ++column) {
    double replaced[3][3];
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) replaced[i][j] = j == column ? xyz[i] : m[i][j];
    rgb[column] = determinant(replaced) / determinant(m);
  }
  return rgb;
}

Vector ycxcz(const Vector& rgb) {
  const Vector xyz = relative_xyz(rgb);
  return {116 * xyz[1] - 16, 500 * (xyz[0] - xyz[1]), 200 * (xyz[1] - xyz[2])};
}

Vector rgb_of_ycxcz(const Vector& c) {
  const double y = (c[0] + 16) / 116;
  return rgb_of({y + c[1] / 500, y, y - c[2] / 200});
}

Vector hunt_lab(const Vector& rgb) {
  Vector f = relative_xyz(rgb);
  constexpr double kDelta = 6.0 / 29;
  for (double& t : f) t = t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
  const double lightness = 116 * f[1] - 16;
  return {lightness, 0.01 * lightness * 500 * (f[0] - f[1]), 0.01 * lightness * 200 * (f[1] - f[2])};
}

double hyab(const Vector& p, const Vector& q) { return std::abs(p[0] - q[0]) + std::hypot(p[1] - q[1], p[2] - q[2]); }

/// q_c = 0.7, p_c = 0.4, p_t = 0.95.
double color_error(const Vector& hunt_a, const Vector& hunt_b) {
  const double maximum = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), 0.7);
  const double error = std::pow(hyab(hunt_a, hunt_b), 0.7);
  if (error < 0.4 * maximum) return 0.95 / (0.4 * maximum) * error;
  return 0.95 + (error - 0.4 * maximum) / (maximum - 0.4 * maximum) * 0.05;
}

struct Kernel {
  int radius;
  std::vector<double> weights;  ///< [2 radius + 1][2 radius + 1]
};

Kernel csf(double a1, double b1, double a2, double b2, double ppd) {
  Kernel kernel{static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * kPi * kPi)) * ppd)), {}};
  double sum = 0;
  for (int y = -kernel.radius; y <= kernel.radius; ++y)
    for (int x = -kernel.radius; x <= kernel.radius; ++x) {
      const double z = (x * x + y * y) / (ppd * ppd);
      kernel.weights.push_back(a1 * std::sqrt(kPi / b1) * std::exp(-kPi * kPi * z / b1) +
                               a2 * std::sqrt(kPi / b2) * std::exp(-kPi * kPi * z / b2));
      sum += kernel.weights.back();
    }
  for (double& weight : kernel.weights) weight /= sum;
  return kernel;
}

Kernel feature(bool point, bool along_x, double ppd) {
  const double sigma = 0.5 * 0.082 * ppd;
  Kernel kernel{static_cast<int>(std::ceil(3 * sigma)), {}};
  double positive = 0, negative = 0;
  for (int y = -kernel.radius; y <= kernel.radius; ++y)
    for (int x = -kernel.radius; x <= kernel.radius; ++x) {
      const double g = std::exp(-(x * x + y * y) / (2 * sigma * sigma)), along = along_x ? x : y;
      const double weight = point ? (along * along / (sigma * sigma) - 1) * g : -along * g;
      kernel.weights.push_back(weight);
      (weight > 0 ? positive : negative) += std::abs(weight);
    }
  for (double& weight : kernel.weights) weight /= weight > 0 ? positive : negative;
  return kernel;
}

struct Plane {
  int width, height;
  std::vector<double> values;
  double at(int x, int y) const {
    return values[static_cast<std::size_t>(std::clamp(y, 0, height - 1) * width + std::clamp(x, 0, width - 1))];
  }
};

Plane convolve(const Plane& plane, const Kernel& kernel) {
  Plane result{plane.width, plane.height, {}};
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x) {
      double sum = 0;
      std::size_t k = 0;
      for (int dy = -kernel.radius; dy <= kernel.radius; ++dy)
        for (int dx = -kernel.radius; dx <= kernel.radius; ++dx) sum += kernel.weights[k++] * plane.at(x + dx, y + dy);
      result.values.push_back(sum);
    }
  return result;
}

std::array<Plane, 3> opponent(const Image8& image) {
  std::array<Plane, 3> planes;
  for (Plane& plane : planes) plane = {image.width, image.height, {}};
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* code = image.at(x, y);
      const Vector c = ycxcz({linear(code[0]), linear(code[1]), linear(code[2])});
      for (std::size_t i = 0; i < 3; ++i) planes[i].values.push_back(c[i]);
    }
  return planes;
}

/// Hunt-adjusted L*a*b* of every pixel.
std::vector<Vector> perceived(const std::array<Plane, 3>& planes, double ppd) {
  const Plane y = convolve(planes[0], csf(1, 0.0047, 0, 1e-5, ppd)),
              cx = convolve(planes[1], csf(1, 0.0053, 0, 1e-5, ppd)),
              cz = convolve(planes[2], csf(34.1, 0.04, 13.5, 0.025, ppd));
  std::vector<Vector> result;
  for (std::size_t i = 0; i < y.values.size(); ++i) {
    Vector rgb = rgb_of_ycxcz({y.values[i], cx.values[i], cz.values[i]});
    for (double& value : rgb) value = std::clamp(value, 0.0, 1.0);
    result.push_back(hunt_lab(rgb));
  }
  return result;
}

std::vector<double> feature_strength(const Plane& y, bool point, double ppd) {
  Plane luminance = y;
  for (double& value : luminance.values) value = (value + 16) / 116;
  const Plane horizontal = convolve(luminance, feature(point, true, ppd)),
              vertical = convolve(luminance, feature(point, false, ppd));
  std::vector<double> result;
  for (std::size_t i = 0; i < horizontal.values.size(); ++i)
    result.push_back(std::hypot(horizontal.values[i], vertical.values[i]));
  return result;
}

std::vector<double> flip(const Image8& a, const Image8& b, double ppd) {
  const std::array<Plane, 3> planes_a = opponent(a), planes_b = opponent(b);
  const std::vector<Vector> perceived_a = perceived(planes_a, ppd), perceived_b = perceived(planes_b, ppd);
  const std::vector<double> edge_a = feature_strength(planes_a[0], false, ppd),
                            edge_b = feature_strength(planes_b[0], false, ppd),
                            point_a = feature_strength(planes_a[0], true, ppd),
                            point_b = feature_strength(planes_b[0], true, ppd);
  std::vector<double> result;
  for (std::size_t i = 0; i < edge_a.size(); ++i) {
    const double difference = std::max(std::abs(edge_a[i] - edge_b[i]), std::abs(point_a[i] - point_b[i]));
    result.push_back(std::pow(color_error(perceived_a[i], perceived_b[i]), 1 - std::sqrt(difference / std::sqrt(2.0))));
  }
  return result;
}

}  // namespace slow

Image8 constant(int width, int height, const std::array<int, 3>& rgb) {
  Image8 image(width, height, 3);
  for (std::size_t i = 0; i < image.bytes.size(); ++i) image.bytes[i] = static_cast<std::uint8_t>(rgb[i % 3]);
  return image;
}

/// Noise on a bright half and a dark half: edges, points and colours of all kinds.
Image8 busy(int width, int height, unsigned seed, int amplitude) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> noise(-amplitude, amplitude);
  Image8 image(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c)
        image.at(x, y)[c] = static_cast<std::uint8_t>(std::clamp((2 * x > y + c ? 200 : 40) + noise(random), 0, 255));
  return image;
}

TEST(Flip, IdenticalImagesHaveNoError) {
  const Image8 image = busy(50, 40, 1, 60);
  const Result<FlipResult> result = flip(image, image);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->error, std::vector<float>(2000, 0.0f));
  EXPECT_EQ(result->mean, 0);
}

TEST(Flip, ConstantImagesHaveTheErrorOfTheirColours) {
  // No filter changes a constant image and there are no features, so the colour formulae alone remain.
  const std::array<std::array<int, 3>, 8> colors = {{{0, 0, 0},
                                                     {255, 255, 255},
                                                     {255, 0, 0},
                                                     {0, 255, 0},
                                                     {0, 0, 255},
                                                     {128, 128, 128},
                                                     {130, 128, 126},
                                                     {20, 5, 3}}};
  for (const auto& p : colors)
    for (const auto& q : colors) {
      const Result<FlipResult> result = flip(constant(20, 5, p), constant(20, 5, q));
      ASSERT_TRUE(result);
      const auto linear = [](const std::array<int, 3>& c) {
        return slow::Vector{slow::linear(c[0]), slow::linear(c[1]), slow::linear(c[2])};
      };
      const double expected = slow::color_error(slow::hunt_lab(linear(p)), slow::hunt_lab(linear(q)));
      // float: 1e-6 of 100 in L*, so 1e-4 in a distance; q_c makes small distances relatively less exact.
      for (const float error : result->error) ASSERT_NEAR(error, expected, 1e-4);
      EXPECT_NEAR(result->mean, expected, 1e-4);
    }
}

TEST(Flip, GreenAndBlueAreFurthestApart) {  // also in one pixel
  EXPECT_NEAR(flip(constant(1, 1, {0, 255, 0}), constant(1, 1, {0, 0, 255}))->mean, 1, 1e-6);
}

TEST(Flip, GreyOfHalfTheLuminanceIsWorthThis) {
  // By hand: codes 188 and 255 are linear 0.50289 and 1; L* 76.27 and 100; distance 23.73, to the 0.7 it is 9.177.
  // L*a*b* of green (87.73, -86.18, 83.18) and blue (32.30, 79.19, -107.86), Hunt-adjusted 203.3 apart: c_max 41.27,
  // the knee at 16.51; 0.95 * 9.177 / 16.51 = 0.5281.
  EXPECT_NEAR(flip(constant(4, 4, {188, 188, 188}), constant(4, 4, {255, 255, 255}))->mean, 0.5281, 0.001);
}

TEST(Flip, AgreesWithTwoDimensionalFiltersInDouble) {
  for (const double ppd : {10.0, 24.0, 67.0206}) {
    const Image8 a = busy(33, 21, 1, 60), b = busy(33, 21, 2, 60);
    const Result<FlipResult> result = flip(a, b, {ppd});
    ASSERT_TRUE(result);
    const std::vector<double> expected = slow::flip(a, b, ppd);
    double mean = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      // 1e-7 of a feature difference near 0 becomes 3e-4 in its root.
      ASSERT_NEAR(result->error[i], expected[i], 3e-4) << "pixel " << i << " at " << ppd;
      mean += expected[i] / static_cast<double>(expected.size());
    }
    EXPECT_NEAR(result->mean, mean, 1e-5);
    EXPECT_GT(result->mean, 0.01);
  }
}

TEST(Flip, IsSymmetric) {
  const Image8 a = busy(40, 30, 1, 50), b = busy(40, 30, 2, 20);
  EXPECT_EQ(flip(a, b)->error, flip(b, a)->error);
}

TEST(Flip, MirroringTheImagesMirrorsTheError) {
  const Image8 a = busy(40, 30, 1, 50), b = busy(40, 30, 2, 20);
  const auto mirrored = [](const Image8& image) {
    Image8 result = image;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) std::copy_n(image.at(x, y), 3, result.at(image.width - 1 - x, y));
    return result;
  };
  const FlipResult straight = *flip(a, b), mirror = *flip(mirrored(a), mirrored(b));
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x)
      ASSERT_NEAR(straight.error[static_cast<std::size_t>(y * 40 + x)],
                  mirror.error[static_cast<std::size_t>(y * 40 + 39 - x)], 1e-4);
}

TEST(Flip, BiggerDifferenceIsABiggerError) {
  const Image8 reference = constant(32, 32, {100, 100, 100});
  double last = 0;
  for (const int step : {1, 2, 5, 10, 30, 80, 155}) {
    Image8 test = reference;
    std::fill_n(test.at(10, 10), 3 * 8, static_cast<std::uint8_t>(100 + step));
    const double mean = flip(test, reference)->mean;
    EXPECT_GT(mean, last) << step;
    last = mean;
  }
}

TEST(Flip, ErrorsAreWithinZeroAndOne) {
  std::mt19937 random(4);
  Image8 a(64, 48, 3), b(64, 48, 3);
  for (std::uint8_t& byte : a.bytes) byte = random() % 2 ? 255 : 0;
  for (std::uint8_t& byte : b.bytes) byte = random() % 2 ? 255 : 0;
  for (const double ppd : {4.0, 67.0, 1000.0}) {
    const FlipResult result = *flip(a, b, {ppd});
    for (const float error : result.error) {
      ASSERT_GE(error, 0);
      ASSERT_LE(error, 1);
    }
  }
}

TEST(Flip, FireflyCountsMoreThanItsColourAlone) {
  const Image8 reference = constant(41, 41, {60, 60, 60});
  Image8 test = reference;
  std::fill_n(test.at(20, 20), 3, std::uint8_t{255});
  const std::size_t center = 20 * 41 + 20;
  const double ppd = 67;
  const auto planes_test = slow::opponent(test), planes_reference = slow::opponent(reference);
  const double color_only =
      slow::color_error(slow::perceived(planes_test, ppd)[center], slow::perceived(planes_reference, ppd)[center]);
  EXPECT_GT(flip(test, reference, {ppd})->error[center], color_only + 0.02);
}

TEST(Flip, FinePatternFadesWithDistance) {
  Image8 checkerboard(64, 64, 3);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      std::fill_n(checkerboard.at(x, y), 3, static_cast<std::uint8_t>((x + y) % 2 ? 255 : 0));
  const Image8 grey = constant(64, 64, {188, 188, 188});  // the same mean light
  double last = 1;
  for (const double ppd : {10.0, 30.0, 67.0}) {
    const double mean = flip(checkerboard, grey, {ppd})->mean;
    EXPECT_LT(mean, last) << ppd;
    last = mean;
  }
  EXPECT_LT(last, 0.05);
}

TEST(Flip, AlphaIsIgnored) {
  const Image8 rgb = busy(10, 10, 1, 60), other = busy(10, 10, 2, 60);
  Image8 rgba(10, 10, 4);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 10; ++x) {
      std::copy_n(rgb.at(x, y), 3, rgba.at(x, y));
      rgba.at(x, y)[3] = static_cast<std::uint8_t>(20 * x);
    }
  EXPECT_EQ(flip(rgba, other)->error, flip(rgb, other)->error);
}

TEST(Flip, DefaultIsThePapersMonitor) {
  EXPECT_NEAR(FlipSettings().pixels_per_degree, 67.0206, 1e-4);
  EXPECT_NEAR(pixels_per_degree(0.5, 1920, 0.6), 27.9253, 1e-4);
}

TEST(Flip, InputOutOfRangeIsAnError) {
  const Image8 image(2, 1, 3), tall(1, 2, 3);
  const Result<FlipResult> result = flip(image, tall);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().message, "found images of 2 x 1 and 1 x 2 pixels, expected the same extents to compare");
  EXPECT_FALSE(flip(Image8(), Image8()));
  for (const double ppd : {0.0, -67.0, 3.9, 1001.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_FALSE(flip(image, image, {ppd})) << ppd;
}

TEST(FlipLinear, OfDecodedBytesIsFlip) {
  const Image8 a = busy(33, 21, 1, 60), b = busy(33, 21, 2, 60);
  const auto light = [](const Image8& image) {
    Image result(image.width, image.height);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        for (int c = 0; c < 3; ++c) result.at(x, y)[c] = static_cast<float>(slow::linear(image.at(x, y)[c]));
    return result;
  };
  const auto result = flip_linear(light(a), light(b), {24});
  ASSERT_TRUE(result);
  const FlipResult expected = *flip(a, b, {24});
  for (std::size_t i = 0; i < expected.error.size(); ++i) ASSERT_NEAR(result->error[i], expected.error[i], 3e-4) << i;
  EXPECT_NEAR(result->mean, expected.mean, 1e-6);
}

TEST(FlipLinear, SeesWhatRoundingToBytesHides) {
  // Greys 0.18 and 0.1806 are both code 118.
  const double mean = flip_linear(Image(4, 4, Color(0.1806f)), Image(4, 4, Color(0.18f)))->mean;
  const slow::Vector brighter{0.1806, 0.1806, 0.1806}, darker{0.18, 0.18, 0.18};
  EXPECT_NEAR(mean, slow::color_error(slow::hunt_lab(brighter), slow::hunt_lab(darker)), 1e-4);
  EXPECT_GT(mean, 0.005);
}

TEST(FlipLinear, ValuesBeyondAMonitorAreClamped) {
  EXPECT_EQ(flip_linear(Image(3, 3, Color(7)), Image(3, 3, Color(1)))->mean, 0);
  EXPECT_EQ(flip_linear(Image(3, 3, Color(-7)), Image(3, 3, Color(0)))->mean, 0);
}

TEST(FlipLinear, InputOutOfRangeIsAnError) {
  Image image(2, 1), bad = image;
  bad.at(1, 0).b = std::numeric_limits<float>::infinity();
  EXPECT_EQ(flip_linear(bad, image).error().message,
            "found a NaN or an infinity in pixel (1, 0) of the test image, expected finite values");
  EXPECT_FALSE(flip_linear(image, Image(1, 2)));
  EXPECT_FALSE(flip_linear(image, image, {3.9}));
}

TEST(HeatMap, LuminanceGrowsWithTheValue) {
  double last = -1;
  for (int i = 0; i <= 100; ++i) {
    const std::array<std::uint8_t, 3> color = heat_color(static_cast<float>(i) / 100);
    const double luminance =
        0.2126 * slow::linear(color[0]) + 0.7152 * slow::linear(color[1]) + 0.0722 * slow::linear(color[2]);
    EXPECT_GT(luminance, last) << i;
    last = luminance;
  }
}

TEST(HeatMap, ValuesOutOfRangeAreClamped) {
  EXPECT_EQ(heat_color(-1), heat_color(0));
  EXPECT_EQ(heat_color(std::numeric_limits<float>::quiet_NaN()), heat_color(0));
  EXPECT_EQ(heat_color(2), heat_color(1));
  EXPECT_EQ(heat_color(0), (std::array<std::uint8_t, 3>{0, 0, 4}));
  EXPECT_EQ(heat_color(1), (std::array<std::uint8_t, 3>{252, 253, 191}));
}

TEST(HeatMap, ShowsEveryPixel) {
  EXPECT_EQ(heat_map({2, 1, {0, 1}, 0.5}).bytes, (std::vector<std::uint8_t>{0, 0, 4, 252, 253, 191}));
}

}  // namespace
}  // namespace brume
