#include "renderer/lights/environment_map.h"

#include <gtest/gtest.h>

#include <vector>

#include "renderer/film/image_io.h"
#include "renderer/lights/image_environment.h"
#include "tests/support/statistics.h"
#include "tests/unit/lights/environment_pictures.h"

namespace brume {
namespace {

/// Each pixel's share of the light: mean of the interpolated luminance, by points of whose row and column half lie on
/// either side of the middle, which is exact for a function that is bilinear in each quarter; times its solid angle.
std::vector<double> shares_of_pixels(const EnvironmentMap& map) {
  constexpr int kPoints = 4;
  std::vector<double> shares;
  double sum = 0;
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      double mean = 0;
      for (int j = 0; j < kPoints; ++j)
        for (int i = 0; i < kPoints; ++i)
          mean += double(luminance(map.radiance(
              seen_at((x + (i + 0.5) / kPoints) / map.width(), (y + (j + 0.5) / kPoints) / map.height()))));
      const double top = std::cos(kPiD * y / map.height()), bottom = std::cos(kPiD * (y + 1) / map.height());
      shares.push_back(mean * (top - bottom));
      sum += shares.back();
    }
  for (double& s : shares) s /= sum;
  return shares;
}

TEST(EnvironmentMap, TheMiddleIsAlongXTheUpperEdgeIsZAndRightOfTheMiddleIsMinusY) {
  Image picture(64, 32);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x)
      picture.at(x, y) = {(static_cast<float>(x) + 0.5f) / 64, (static_cast<float>(y) + 0.5f) / 32, 1};
  const EnvironmentMap map(picture);
  const auto is_at = [&](Vec3 direction, float u, float v) {
    const Color c = map.radiance(direction);
    EXPECT_NEAR(c.r, u, 1e-5f) << direction.x << ' ' << direction.y << ' ' << direction.z;
    EXPECT_NEAR(c.g, v, 1e-5f) << direction.x << ' ' << direction.y << ' ' << direction.z;
  };
  is_at({1, 0, 0}, 0.5f, 0.5f);
  is_at({0, -1, 0}, 0.75f, 0.5f);
  is_at({0, 1, 0}, 0.25f, 0.5f);
  is_at(normalize(Vec3(1, 0, 1)), 0.5f, 0.25f);
  is_at(normalize(Vec3(1, -1, 0)), 0.625f, 0.5f);
  EXPECT_NEAR(map.radiance({0, 0, 1}).g, 0.5 / 32, 1e-6);
  EXPECT_NEAR(map.radiance({0, 0, -1}).g, 31.5 / 32, 1e-6);
  // At the back the left and the right edge meet.
  EXPECT_NEAR(map.radiance({-1, 0, 0}).r, 0.5, 1e-5);
  EXPECT_NEAR(map.radiance(normalize(Vec3(-1, 0.3f, 0))).r, 0.5 * std::atan(0.3) / kPiD, 1e-5);
  EXPECT_NEAR(map.radiance(normalize(Vec3(-1, -0.3f, 0))).r, 1 - 0.5 * std::atan(0.3) / kPiD, 1e-5);
}

TEST(EnvironmentMap, IsThePixelsAtTheirCentresAndLinearBetweenThem) {
  const Image picture = patchy(12, 6);
  const EnvironmentMap map(picture);
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 12; ++x) {
      const double u = (x + 0.5) / 12, v = (y + 0.5) / 6;
      const Color here = picture.at(x, y), right = picture.at((x + 1) % 12, y),
                  below = picture.at(x, std::min(y + 1, 5));
      // Places are rounded by 2e-7 of the picture, 3e-6 of a pixel.
      const float tolerance = 1e-5f * (here.g + right.g + below.g);
      EXPECT_NEAR(map.radiance(seen_at(u, v)).g, here.g, tolerance);
      EXPECT_NEAR(map.radiance(seen_at(u + 0.25 / 12, v)).g, 0.75f * here.g + 0.25f * right.g, tolerance);
      EXPECT_NEAR(map.radiance(seen_at(u, v + 0.25 / 6)).g, 0.75f * here.g + 0.25f * below.g, tolerance);
    }
}

TEST(EnvironmentMap, DensityIsTheMeanLuminanceOfThePixelTimesItsSolidAngle) {
  for (const Image& picture : {patchy(24, 12), patchy(5, 9), one_bright_pixel(16, 8, 0, 0), Image(8, 4, Color(2))}) {
    const EnvironmentMap map(picture);
    const std::vector<double> shares = shares_of_pixels(map);
    const double cells = double(picture.width) * picture.height;
    for (std::uint32_t i = 0; i < 2000; ++i) {
      const Vec2 p = random_pair(i);
      const double x = double(p.x) * picture.width, y = double(p.y) * picture.height;
      // On the edge between two pixels rounding decides whose density it is.
      if (std::abs(x - std::round(x)) < 1e-4 || std::abs(y - std::round(y)) < 1e-4) continue;
      const double pdf = double(map.pdf_w(seen_at(double(p.x), double(p.y))));
      const double expected =
          shares[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(x)] *
          cells;
      // The distribution functions are in float: 6e-8 of the sum, per pixel. sin(theta) is known to 2e-7.
      ASSERT_NEAR(per_place(pdf, double(p.y)), expected,
                  2e-7 * cells + expected * (1e-5 + 4e-7 / std::sin(kPiD * double(p.y))))
          << x << ", " << y;
    }
  }
}

TEST(EnvironmentMap, SamplesFollowTheDensity) {
  constexpr int kN = 100000, kInside = 2;  // bins per pixel each way
  for (const Image& picture : {patchy(24, 12), patchy(3, 7), Image(8, 4, Color(2))}) {
    const EnvironmentMap map(picture);
    const std::vector<double> shares = shares_of_pixels(map);
    const auto columns = static_cast<std::size_t>(picture.width * kInside);
    const auto rows = static_cast<std::size_t>(picture.height * kInside);
    std::vector<double> observed(columns * rows), expected;
    for (std::size_t y = 0; y < rows; ++y)
      for (std::size_t x = 0; x < columns; ++x)
        expected.push_back(kN * shares[y / kInside * (columns / kInside) + x / kInside] / (kInside * kInside));
    for (std::uint32_t i = 0; i < kN; ++i) {
      const Vec3 w = map.sample(random_pair(i)).direction;
      ASSERT_NEAR(length(w), 1, 4e-7f);
      const Place p = place_of(w);
      ++observed[std::min(rows - 1, static_cast<std::size_t>(p.v * double(rows))) * columns +
                 std::min(columns - 1, static_cast<std::size_t>(p.u * double(columns)))];
    }
    EXPECT_GT(chi_square_p_value(observed, expected), kChiSquareSignificance) << picture.width;
  }
}

TEST(EnvironmentMap, ReportedDensityIsTheOneOfTheDirection) {
  for (const Image& picture : {patchy(24, 12), patchy(512, 256), one_bright_pixel(16, 8, 3, 4), Image(8, 4)}) {
    const EnvironmentMap map(picture);
    int compared = 0;
    for (std::uint32_t i = 0; i < 20000; ++i) {
      const auto s = map.sample(random_pair(i));
      ASSERT_GT(s.pdf_w, 0);
      const Place p = place_of(s.direction);
      const double x = p.u * picture.width, y = p.v * picture.height;
      if (std::abs(x - std::round(x)) < 1e-3 || std::abs(y - std::round(y)) < 1e-3) continue;  // rounding decides
      // sin(theta) is known to 4e-7: near a pole the density is not known better than that.
      ASSERT_NEAR(map.pdf_w(s.direction) / s.pdf_w, 1, 1e-5 + 6e-7 / std::sin(kPiD * p.v)) << x << ", " << y;
      ++compared;
    }
    EXPECT_GT(compared, 19000);
  }
}

TEST(EnvironmentMap, DensityIntegratesToOne) {
  const double z = sidak_z(1e-3, 5);
  for (const Image& picture :
       {patchy(24, 12), patchy(3, 7), one_bright_pixel(16, 8, 15, 7), Image(8, 4), Image(1, 1)}) {
    const EnvironmentMap map(picture);
    RunningMean integral;
    for (std::uint32_t i = 0; i < 100000; ++i) {
      const Vec2 p = random_pair(i);
      integral.add(per_place(double(map.pdf_w(seen_at(double(p.x), double(p.y)))), double(p.y)));
    }
    EXPECT_NEAR(integral.mean(), 1, z * integral.standard_error() + 2e-6) << picture.width;
  }
}

TEST(EnvironmentMap, DensityIsPositiveWhereverThereIsLight) {
  // With a sun of a million times the sky's light, too: what is left of the row must not be lost by rounding.
  Image sun(64, 32, Color(1));
  sun.at(20, 8) = Color(1e6f);
  for (const Image& picture : {patchy(24, 12), patchy(64, 2), one_bright_pixel(16, 8, 0, 3), sun}) {
    const EnvironmentMap map(picture);
    int lit = 0;
    for (std::uint32_t i = 0; i < 50000; ++i) {
      const Vec2 p = random_pair(i);
      const double x = double(p.x) * picture.width, y = double(p.y) * picture.height;
      const Vec3 w = seen_at(double(p.x), double(p.y));
      if (is_black(map.radiance(w))) continue;
      if (std::abs(x - std::round(x)) < 1e-4 || std::abs(y - std::round(y)) < 1e-4) continue;  // rounding decides
      ++lit;
      ASSERT_GT(map.pdf_w(w), 0) << x << ", " << y;
    }
    EXPECT_GT(lit, 500);
  }
}

TEST(EnvironmentMap, ASingleBrightPixelIsAllThatIsSampled) {
  constexpr int kWidth = 16, kHeight = 8;
  const double z = sidak_z(1e-3, 4);
  struct Pixel {
    int x, y;
  };
  for (const Pixel pixel : {Pixel{5, 3}, {0, 4}, {15, 4}, {7, 0}}) {
    const EnvironmentMap map(one_bright_pixel(kWidth, kHeight, pixel.x, pixel.y));
    RunningMean light;
    for (std::uint32_t i = 0; i < 20000; ++i) {
      const auto s = map.sample(random_pair(i));
      const Place p = place_of(s.direction);
      double away = std::abs(p.u * kWidth - (pixel.x + 0.5));
      away = std::min(away, kWidth - away);
      ASSERT_LE(away, 1.5 + 1e-4) << "beyond the next pixel";
      ASSERT_LE(std::abs(p.v * kHeight - (pixel.y + 0.5)), 1.5 + 1e-4);
      light.add(double(map.radiance(s.direction).g) / double(s.pdf_w));
    }
    // Integral of the tent of two pixels' width: exactly, row by row, of the vertical part times the solid angle.
    const double expected = 200 * 2 * kPiD / kWidth *
                            integrate(
                                [&](double v) {
                                  const double y = v * kHeight - 0.5,
                                               edge =
                                                   pixel.y == 0 && y < 0 ? 1 : std::max(0.0, 1 - std::abs(y - pixel.y));
                                  return edge * kPiD * std::sin(kPiD * v);
                                },
                                0, 1, kHeight * 8);
    EXPECT_NEAR(light.mean() / expected, 1, z * light.standard_error() / expected + 1e-5) << pixel.x << ", " << pixel.y;
    EXPECT_LT(map.solid_angle(), 6 * 2 * kPi * kPi / (kWidth * kHeight));
  }
}

TEST(EnvironmentMap, TheSmallestPicturesWork) {
  for (const Image& picture : {Image(1, 1, Color(3)), Image(2, 1, Color(3)), Image(1, 2, Color(3))}) {
    const EnvironmentMap map(picture);
    for (std::uint32_t i = 0; i < 2000; ++i) {
      const auto s = map.sample(random_pair(i));
      ASSERT_NEAR(map.radiance(s.direction).r, 3, 1e-6f);
      ASSERT_TRUE(std::isfinite(s.pdf_w) && s.pdf_w > 0);
    }
    EXPECT_EQ(map.radiance({0, 0, 1}), Color(3));
    EXPECT_EQ(map.radiance({-1, 0, 0}), Color(3));
  }
  // Two pixels: the left one is at +y, the right one at -y, and both edges are half way.
  Image two(2, 1);
  two.at(0, 0) = {1, 0, 0}, two.at(1, 0) = {0, 1, 0};
  const EnvironmentMap map(two);
  EXPECT_NEAR(map.radiance({0, 1, 0}).r, 1, 1e-6f);
  EXPECT_NEAR(map.radiance({0, -1, 0}).g, 1, 1e-6f);
  EXPECT_NEAR(map.radiance({1, 0, 0}).r, 0.5, 1e-6f);
  EXPECT_NEAR(map.radiance({-1, 0, 0}).r, 0.5, 1e-6f);
  EXPECT_NEAR(map.radiance({-1, 0, 0}).g, 0.5, 1e-6f);
}

TEST(EnvironmentMap, AConstantPictureGivesTheIrradianceOfAConstantSky) {
  const EnvironmentMap map(Image(16, 8, Color(2)));
  EXPECT_NEAR(map.solid_angle(), 4 * kPiD, 1e-4);
  const double z = sidak_z(1e-3, 4);
  for (const Vec3 normal : {Vec3(0, 0, 1), Vec3(1, 0, 0), normalize(Vec3(-1, 2, -2))}) {
    RunningMean irradiance;
    for (std::uint32_t i = 0; i < 50000; ++i) {
      const auto s = map.sample(random_pair(i));
      irradiance.add(double(map.radiance(s.direction).r * std::max(0.0f, dot(normal, s.direction)) / s.pdf_w));
    }
    EXPECT_NEAR(irradiance.mean(), 2 * kPiD, z * irradiance.standard_error());
  }
  RunningMean all;
  for (std::uint32_t i = 0; i < 50000; ++i) {
    const auto s = map.sample(random_pair(i));
    all.add(double(map.radiance(s.direction).r / s.pdf_w));
  }
  EXPECT_NEAR(all.mean(), 8 * kPiD, z * all.standard_error());
}

TEST(EnvironmentMap, ABlackPictureIsSampledButGivesNothing) {
  const EnvironmentMap map(Image(8, 4));
  EXPECT_EQ(map.solid_angle(), 0);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const auto s = map.sample(random_pair(i));
    ASSERT_NEAR(length(s.direction), 1, 4e-7f);
    ASSERT_TRUE(std::isfinite(s.pdf_w) && s.pdf_w > 0);
    ASSERT_TRUE(is_black(map.radiance(s.direction)));
  }
}

TEST(EnvironmentMap, ImpossibleValuesAreCountedAndCountAsZero) {
  Image picture(4, 2, Color(1));
  picture.at(0, 0) = {std::numeric_limits<float>::quiet_NaN(), 2, -3};
  picture.at(3, 1) = {kInfinity, -kInfinity, -0.0f};
  const EnvironmentMap map(picture);
  EXPECT_EQ(map.mended(), 4u);  // -0 is 0
  const Color c = map.radiance(seen_at(0.125, 0.25));
  EXPECT_NEAR(c.r, 0, 1e-6f);
  EXPECT_NEAR(c.g, 2, 1e-5f);
  EXPECT_NEAR(c.b, 0, 1e-6f);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const auto s = map.sample(random_pair(i));
    ASSERT_TRUE(std::isfinite(s.pdf_w) && s.pdf_w > 0 && is_finite(map.radiance(s.direction)));
  }
  EXPECT_EQ(EnvironmentMap(Image(4, 2, Color(1))).mended(), 0u);
}

TEST(EnvironmentMap, TheLargestAndSmallestFiniteValuesKeepADensity) {
  for (const float value : {std::numeric_limits<float>::max(), 1e38f, 1e-37f}) {
    const EnvironmentMap map(Image(4, 2, Color(value)));
    EXPECT_EQ(map.mended(), 0u);
    for (std::uint32_t i = 0; i < 100; ++i) {
      const auto s = map.sample(random_pair(i));
      ASSERT_TRUE(std::isfinite(s.pdf_w) && s.pdf_w > 0) << value << ": " << s.pdf_w;
    }
  }
}

TEST(EnvironmentMap, EndsOfTheUnitSquareAreFinite) {
  for (const Image& picture : {patchy(24, 12), Image(1, 1, Color(1)), Image(4, 2)})
    for (const float x : {0.0f, 0x1.fffffep-1f})
      for (const float y : {0.0f, 0x1.fffffep-1f}) {
        const auto s = EnvironmentMap(picture).sample({x, y});
        EXPECT_NEAR(length(s.direction), 1, 4e-7f);
        EXPECT_TRUE(std::isfinite(s.pdf_w) && s.pdf_w >= 0) << x << ", " << y << ": " << s.pdf_w;
      }
}

}  // namespace
}  // namespace brume
