#include "renderer/film/display_transform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

namespace brume {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

int code_of(float value, const DisplaySettings& settings = {}) {
  return to_display(Image(1, 1, Color(value)), settings).bytes[0];
}

std::vector<DisplaySettings> all_settings() {
  std::vector<DisplaySettings> settings;
  for (const float stops : {0.0f, -3.5f, 7.0f}) {
    settings.push_back({stops, DisplayCurve::Srgb});
    settings.push_back({stops, DisplayCurve::Filmic});
    for (const float gamma : {1.0f, 1.8f, 2.2f, 4.0f}) settings.push_back({stops, DisplayCurve::Gamma, gamma});
  }
  return settings;
}

std::string describe(const DisplaySettings& s) {
  return "curve " + std::to_string(static_cast<int>(s.curve)) + ", gamma " + std::to_string(s.gamma) + ", stops " +
         std::to_string(s.exposure_stops);
}

/// Increasing values from far below the first code to far above the last, 1/700 octave apart.
Image sweep() {
  Image image(56 * 700, 1);
  for (int x = 0; x < image.width; ++x) image.at(x, 0) = Color(std::exp2(static_cast<float>(x) / 700 - 48));
  return image;
}

TEST(DisplayTransform, KnownValuesOfSrgb) {
  // IEC 61966-2-1 by hand: 1.055 * 0.5^(1/2.4) - 0.055 = 0.735357; 0.18: 0.461356; 0.001 * 12.92.
  EXPECT_NEAR(srgb_encode(0.5), 0.735357, 1e-6);
  EXPECT_NEAR(srgb_encode(0.18), 0.461356, 1e-6);
  EXPECT_NEAR(srgb_encode(0.001), 0.01292, 1e-12);
  EXPECT_EQ(code_of(0), 0);
  EXPECT_EQ(code_of(0.001f), 3);
  EXPECT_EQ(code_of(0.18f), 118);
  EXPECT_EQ(code_of(0.5f), 188);
  EXPECT_EQ(code_of(1), 255);
  EXPECT_EQ(code_of(1.5f), 255);
}

TEST(DisplayTransform, SrgbDecodeInvertsEncode) {
  for (int i = 0; i <= 1000; ++i) EXPECT_NEAR(srgb_decode(srgb_encode(i / 1000.0)), i / 1000.0, 1e-7) << i;
  for (int code = 0; code < 256; ++code) EXPECT_EQ(code_of(static_cast<float>(srgb_decode(code / 255.0))), code);
}

TEST(DisplayTransform, KnownValuesOfFilmic) {
  // By hand: U(2) = 0.704 / 1.66 - 1/15 = 0.357430, U(11.2) = 19.38 / 24.476 - 1/15 = 0.725129.
  EXPECT_NEAR(hable_filmic(1), 0.492919, 2e-6);
  EXPECT_NEAR(hable_filmic(0), 0, 1e-15);
  EXPECT_NEAR(hable_filmic(5.6), 1, 1e-15);
  EXPECT_EQ(code_of(1, {0, DisplayCurve::Filmic}), 186);  // srgb_encode(0.492919) = 0.730646
  EXPECT_EQ(code_of(4, {0, DisplayCurve::Filmic}), 246);  // U(8) / U(11.2) = 0.918031, encoded 0.963067
}

TEST(DisplayTransform, KnownValuesOfGamma) {
  EXPECT_EQ(code_of(0.5f, {0, DisplayCurve::Gamma, 1.0f}), 128);  // 127.5 rounds up
  EXPECT_EQ(code_of(0.5f, {0, DisplayCurve::Gamma, 2.0f}), 180);  // sqrt(0.5) * 255 = 180.3
  EXPECT_EQ(code_of(0.5f, {0, DisplayCurve::Gamma, 2.2f}), 186);  // 0.729740 * 255 = 186.08
}

TEST(DisplayTransform, OneStopDoublesTheLight) {
  for (const float value : {0.01f, 0.1f, 0.3f}) {
    EXPECT_EQ(code_of(value, {1}), code_of(2 * value));
    EXPECT_EQ(code_of(value, {-2}), code_of(value / 4));
  }
}

TEST(DisplayTransform, RoundsItsDefinition) {
  const Image image = sweep();
  for (const DisplaySettings& settings : all_settings()) {
    const Image8 display = to_display(image, settings);
    for (int x = 0; x < image.width; ++x) {
      const double exact = 255 * display_value(image.at(x, 0).g, settings);
      // Half a code, and what a threshold rounded to float can move it.
      ASSERT_NEAR(display.at(x, 0)[1], exact, 0.5 + 1e-4) << image.at(x, 0).g << " " << describe(settings);
    }
  }
}

TEST(DisplayTransform, BrighterIsNeverDarker) {
  const Image image = sweep();
  for (const DisplaySettings& settings : all_settings()) {
    const Image8 display = to_display(image, settings);
    std::vector<bool> reached(256);
    reached[display.at(0, 0)[0]] = true;
    for (int x = 1; x < image.width; ++x) {
      ASSERT_GE(display.at(x, 0)[0], display.at(x - 1, 0)[0]) << describe(settings);
      reached[display.at(x, 0)[0]] = true;
    }
    EXPECT_EQ(reached, std::vector<bool>(256, true)) << describe(settings);
  }
}

TEST(DisplayTransform, NonFinitePixelsAreLoudMagenta) {
  Image image(5, 1, Color(0.5f));
  image.at(0, 0) = {kNan, 0, 0};
  image.at(1, 0) = {0, 0, -kNan};
  image.at(2, 0) = {0, kInfinity, 0};
  image.at(3, 0) = {-kInfinity, 0, 0};
  for (DisplaySettings settings : all_settings())
    for (const bool dither : {false, true}) {
      settings.dither = dither;
      const Image8 display = to_display(image, settings);
      for (int x = 0; x < 4; ++x) {
        EXPECT_EQ(display.at(x, 0)[0], 255);
        EXPECT_EQ(display.at(x, 0)[1], 0);
        EXPECT_EQ(display.at(x, 0)[2], 255);
      }
      EXPECT_EQ(display.at(4, 0)[0], display.at(4, 0)[1]);
    }
}

TEST(DisplayTransform, ExtremesAreBlackAndWhite) {
  for (DisplaySettings settings : all_settings())
    for (const bool dither : {false, true}) {
      settings.dither = dither;
      for (const float value : {-0.0f, -1e-30f, -1.0f, -3e38f, 1e-44f}) EXPECT_EQ(code_of(value, settings), 0) << value;
      EXPECT_EQ(code_of(3e38f, settings), 255);
    }
  EXPECT_EQ(code_of(1e30f, {64}), 255);  // overflows to infinity on the way, which is no error of the renderer
}

TEST(DisplayTransform, SettingsOutOfRangeAreClamped) {
  EXPECT_EQ(code_of(0.3f, {kNan}), code_of(0.3f));
  EXPECT_EQ(code_of(1e-10f, {kInfinity}), 255);
  EXPECT_EQ(code_of(1e10f, {-kInfinity}), 0);
  const auto gamma = [](float value) { return DisplaySettings{0, DisplayCurve::Gamma, value}; };
  EXPECT_EQ(code_of(0.3f, gamma(kNan)), code_of(0.3f, gamma(2.2f)));
  EXPECT_EQ(code_of(0.3f, gamma(0)), code_of(0.3f, gamma(1)));
  EXPECT_EQ(code_of(0.3f, gamma(100)), code_of(0.3f, gamma(4)));
}

TEST(DisplayTransform, ChannelsAreIndependent) {
  const Image8 display = to_display(Image(1, 1, {0.18f, 1, 0.001f}), {});
  EXPECT_EQ(display.bytes, (std::vector<std::uint8_t>{118, 255, 3}));
}

TEST(DisplayTransform, FourChannelsAreOpaque) {
  Image image(2, 1, {0.18f, 0.5f, 1});
  image.at(1, 0) = Color(kNan);
  const Image8 display = to_display(image, {}, 4);
  EXPECT_EQ(display.channels, 4);
  EXPECT_EQ(display.bytes, (std::vector<std::uint8_t>{118, 188, 255, 255, 255, 0, 255, 255}));
}

TEST(DisplayTransform, ReusesTheMemoryOfItsArgument) {
  const Image image(16, 9, Color(0.18f));
  Image8 display(16, 9, 4);
  const std::uint8_t* memory = display.bytes.data();
  to_display(image, {}, 3, display);
  EXPECT_EQ(display.bytes.data(), memory);
  EXPECT_EQ(display, to_display(image, {}));
}

TEST(DisplayTransform, DitherKeepsTheMeanOfATile) {
  for (DisplaySettings settings : all_settings()) {
    settings.dither = true;
    for (int step = 1; step < 40; ++step) {
      const float value = static_cast<float>(step) / 40 * std::exp2(-settings.exposure_stops);
      const Image8 display = to_display(Image(8, 8, Color(value)), settings);
      double sum = 0;
      for (const std::uint8_t byte : display.bytes) sum += byte;
      // 64 levels between two codes; a curve bends by less than 1/50 of a code within one (gamma 4 near black).
      EXPECT_NEAR(sum / 192, 255 * display_value(value, settings), 1 / 128.0 + 0.02) << value << describe(settings);
    }
  }
}

TEST(DisplayTransform, DitherMovesByLessThanOneCodeAndKeepsGrey) {
  Image image = sweep();
  image.width = 392, image.height = 100;  // the same values as a picture of many rows
  for (DisplaySettings settings : all_settings()) {
    settings.dither = true;
    const Image8 display = to_display(image, settings);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const std::uint8_t* pixel = display.at(x, y);
        ASSERT_LT(std::abs(pixel[0] - 255 * display_value(image.at(x, y).r, settings)), 1) << describe(settings);
        ASSERT_EQ(pixel[0], pixel[1]);
        ASSERT_EQ(pixel[0], pixel[2]);
      }
  }
}

TEST(DisplayTransform, DitherUsesAsManyPixelsAsTheFractionSays) {
  // Halfway between codes 100 and 101: half of every tile is lit, and no 2x2 block is all of one kind.
  const auto value = static_cast<float>((srgb_decode(100 / 255.0) + srgb_decode(101 / 255.0)) / 2);
  DisplaySettings settings;
  settings.dither = true;
  const Image8 display = to_display(Image(8, 8, Color(value)), settings);
  for (int y = 0; y < 8; y += 2)
    for (int x = 0; x < 8; x += 2)
      EXPECT_EQ(display.at(x, y)[0] + display.at(x + 1, y)[0] + display.at(x, y + 1)[0] + display.at(x + 1, y + 1)[0],
                402);
}

}  // namespace
}  // namespace brume
