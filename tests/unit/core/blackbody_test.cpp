#include "renderer/core/blackbody.h"

#include <gtest/gtest.h>

#include <cmath>

namespace brume {
namespace {

struct Chromaticity {
  double x, y;
};

/// CIE 1931 chromaticity of a colour in linear Rec. 709.
Chromaticity chromaticity(Color c) {
  const double r = double(c.r), g = double(c.g), b = double(c.b);
  const double x = 0.4123908 * r + 0.3575843 * g + 0.1804808 * b, y = 0.2126390 * r + 0.7151687 * g + 0.0721923 * b,
               z = 0.0193308 * r + 0.1191948 * g + 0.9505322 * b;
  return {x / (x + y + z), y / (x + y + z)};
}

/// Points of the Planckian locus as tables of colour science list them; inside Rec. 709, where nothing is cut off.
TEST(Blackbody, ColoursLieOnThePlanckianLocus) {
  const struct {
    double kelvin, x, y;
  } locus[] = {{2000, 0.5267, 0.4133}, {2500, 0.4770, 0.4137}, {3000, 0.4369, 0.4041}, {4000, 0.3805, 0.3768},
               {5000, 0.3451, 0.3516}, {6500, 0.3135, 0.3237}, {10000, 0.2807, 0.2884}};
  for (const auto& p : locus) {
    const Chromaticity c = chromaticity(blackbody_color(p.kelvin));
    EXPECT_NEAR(c.x, p.x, 0.005) << p.kelvin;  // the fit of the colour matching functions is no better
    EXPECT_NEAR(c.y, p.y, 0.005) << p.kelvin;
  }
}

TEST(Blackbody, LuminanceIsOneAndTheColourFiniteAtEveryTemperature) {
  for (const double kelvin : {20.0, 100.0, 500.0, 800.0, 1500.0, 3000.0, 20000.0, 1e6}) {
    const Color c = blackbody_color(kelvin);
    EXPECT_TRUE(is_finite(c)) << kelvin;
    EXPECT_NEAR(luminance(c), 1, 1e-5) << kelvin;
    EXPECT_GE(std::min({c.r, c.g, c.b}), 0) << kelvin;
  }
  EXPECT_GT(blackbody_color(1500).r, 4 * blackbody_color(1500).g * 0.5f) << "deep orange";
  EXPECT_GT(blackbody_color(12000).b, blackbody_color(12000).r) << "bluish";
}

TEST(Blackbody, GlowFollowsStefanAndBoltzmannAndShowsBoth1500And3000Kelvin) {
  EXPECT_NEAR(luminance(blackbody_glow(3000)), 1, 1e-4);
  EXPECT_NEAR(luminance(blackbody_glow(1500)), 1 / 16.0, 1e-5);
  EXPECT_NEAR(luminance(blackbody_glow(6000)), 16, 2e-3);
  EXPECT_NEAR(luminance(blackbody_glow(15000)), 625, 0.1);
  EXPECT_EQ(blackbody_glow(500), Color());
  EXPECT_EQ(blackbody_glow(-3), Color());
  EXPECT_EQ(blackbody_glow(NAN), Color());
  float before = 0;
  for (float k = 400; k < 14000; k += 7) {
    const float l = luminance(blackbody_glow(k));
    EXPECT_GE(l, before) << k;
    EXPECT_LT(l - before, 0.01f + 0.01f * l) << k << ": no steps";
    before = l;
  }
}

}  // namespace
}  // namespace brume
