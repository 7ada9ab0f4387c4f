#include "renderer/analysis/hdr_flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "renderer/analysis/metric.h"

namespace brume {
namespace {

constexpr int kWidth = 20, kHeight = 13;

/// Colours of all kinds over seven stops: small integers over powers of two, so the numbers are exact anywhere.
Image many_stops() {
  Image image(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < 3; ++c)
        image.at(x, y)[c] = std::ldexp(static_cast<float>((7 * x + 13 * y + 5 * c) % 32 + 1) / 32, x / 3 - 3);
  return image;
}

/// Every value up to a quarter darker or brighter.
Image disturbed(Image image) {
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] *= 1 + static_cast<float>((3 * x + 5 * y + c) % 9 - 4) / 16;
  return image;
}

Image with_black_columns(Image image, int columns) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < columns; ++x) image.at(x, y) = Color();
  return image;
}

Image scaled(Image image, int stops) {
  for (Color& c : image.pixels) c = c * std::ldexp(1.0f, stops);
  return image;
}

HdrFlipSettings seen_from(double pixels_per_degree) { return {.ldr = {pixels_per_degree}}; }

// What the following two expect was computed by a program apart from this one, in Python: the formulae of the two
// papers in double, two-dimensional filters as printed, the inverse of the tone mapper by bisection, k0 to k5 as
// numbers. With the rounded colour matrices of the paper's authors it gives means larger by 3e-6. Single errors: 1e-7
// of a feature difference near 0 becomes 3e-4 in its root; the mean averages that.
struct Expected {
  double pixels_per_degree, mean;
  std::array<double, 6> errors;
};
constexpr std::array<std::array<int, 2>, 6> kLookedAt = {{{0, 0}, {5, 3}, {9, 6}, {13, 2}, {16, 11}, {19, 12}}};

TEST(HdrFlip, AgreesWithAnIndependentProgram) {
  const Expected expected[] = {
      {10, 0.267368050, {0.2628504, 0.1090847, 0.0867751, 0.1630230, 0.1718641, 0.3525775}},
      {24, 0.188486174, {0.1924624, 0.0629277, 0.0667089, 0.0910839, 0.0990874, 0.3037789}},
  };
  for (const Expected& e : expected) {
    const auto result = hdr_flip(disturbed(many_stops()), many_stops(), seen_from(e.pixels_per_degree));
    ASSERT_TRUE(result);
    EXPECT_NEAR(result->start_exposure, -1.7740673, 1e-6);
    EXPECT_NEAR(result->stop_exposure, 2.3395771, 1e-6);
    EXPECT_EQ(result->exposures, 5);  // 4.11 stops
    EXPECT_EQ(result->flip.width, kWidth);
    EXPECT_EQ(result->flip.height, kHeight);
    EXPECT_NEAR(result->flip.mean, e.mean, 1e-5);
    for (std::size_t i = 0; i < kLookedAt.size(); ++i)
      EXPECT_NEAR(result->flip.error[static_cast<std::size_t>(kLookedAt[i][1] * kWidth + kLookedAt[i][0])], e.errors[i],
                  3e-4)
          << i;
  }
}

TEST(HdrFlip, AgreesInARangeThatIsSetAndInOnesOfDarkPictures) {
  HdrFlipSettings set = seen_from(24);
  set.start_exposure = -2.0f, set.stop_exposure = 1.5f;
  const auto result = hdr_flip(disturbed(many_stops()), many_stops(), set);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->start_exposure, -2);
  EXPECT_EQ(result->stop_exposure, 1.5f);
  EXPECT_EQ(result->exposures, 4);  // 3.5 stops
  EXPECT_NEAR(result->flip.mean, 0.186409770, 1e-5);

  struct Dark {
    int black_columns;  // of 20
    double stop, mean;
    int exposures;
  };
  // Less than half of it black: the median of all. More: the median of the others.
  for (const Dark& d : {Dark{5, 2.3395771, 0.145803932, 5}, Dark{11, 0.6106529, 0.085104021, 3}}) {
    const auto dark = hdr_flip(with_black_columns(disturbed(many_stops()), d.black_columns),
                               with_black_columns(many_stops(), d.black_columns), seen_from(24));
    ASSERT_TRUE(dark);
    EXPECT_NEAR(dark->start_exposure, -1.7740673, 1e-6);
    EXPECT_NEAR(dark->stop_exposure, d.stop, 1e-6);
    EXPECT_EQ(dark->exposures, d.exposures);
    EXPECT_NEAR(dark->flip.mean, d.mean, 1e-5);
  }
}

TEST(HdrFlip, GreyIsShownAtTheToneMappersValue) {
  // By hand: 0.6 * 2.118872 = 1.271323 in Narkowicz's curve is (2.51 * 1.616263 + 0.03 * 1.271323) /
  // (2.43 * 1.616263 + 0.59 * 1.271323 + 0.14) = 4.094960 / 4.817600 = 0.85. A light of it needs 0 stops, one four
  // times as bright -2; half of it is, of 0.6 * 1.059436 = 0.635662, 1.033275 / 1.496921 = 0.690267. Constant pictures
  // have no features, so the error is that of the two greys.
  const Image reference(6, 5, Color(4 * 2.118872f)), test(6, 5, Color(2 * 2.118872f));
  const auto result = hdr_flip(test, reference);
  ASSERT_TRUE(result);
  EXPECT_NEAR(result->start_exposure, -2, 1e-6);
  EXPECT_NEAR(result->stop_exposure, -2, 1e-6);
  EXPECT_EQ(result->exposures, 2);
  const double greys = flip_linear(Image(6, 5, Color(0.690267f)), Image(6, 5, Color(0.85f)))->mean;
  EXPECT_GT(greys, 0.1);
  EXPECT_NEAR(result->flip.mean, greys, 1e-5);
}

TEST(HdrFlip, IdenticalPicturesHaveNoError) {
  const auto result = hdr_flip(many_stops(), many_stops());
  ASSERT_TRUE(result);
  EXPECT_EQ(result->flip.error, std::vector<float>(kWidth * kHeight, 0.0f));
  EXPECT_EQ(result->flip.mean, 0);
}

TEST(HdrFlip, SeesInHighlightsWhatOneExposureClips) {
  Image reference(40, 40, Color(0.2f)), test = reference;
  for (int y = 16; y < 24; ++y)
    for (int x = 16; x < 24; ++x) reference.at(x, y) = Color(20), test.at(x, y) = Color(60);
  EXPECT_EQ(flip_at(test, reference, 0)->mean, 0);  // both white
  const auto result = hdr_flip(test, reference);
  ASSERT_TRUE(result);
  EXPECT_GT(result->flip.error[reference.index(20, 20)], 0.1);
  EXPECT_EQ(result->flip.error[0], 0);  // the widest filter reaches 10 pixels
}

TEST(HdrFlip, SeesInShadowsWhatOneExposureHides) {
  Image reference(24, 24, Color(1e-5f)), test(24, 24, Color(3e-5f));
  reference.at(3, 3) = test.at(3, 3) = Color(1);
  EXPECT_EQ(flip_at(test, reference, 0)->mean, 0);  // both black
  EXPECT_GT(hdr_flip(test, reference)->flip.mean, 0.1);
}

TEST(HdrFlip, IsTheLargestErrorOfItsExposures) {
  // -4, -2.5 and -1 stops, in one range of three or two of two.
  const Image test = disturbed(many_stops()), reference = many_stops();
  const auto in_range = [&](float start, float stop) { return *hdr_flip(test, reference, {{24}, start, stop}); };
  const HdrFlipResult whole = in_range(-4, -1), dark = in_range(-4, -2.5f), bright = in_range(-2.5f, -1);
  EXPECT_EQ(whole.exposures, 3);
  EXPECT_EQ(dark.exposures, 2);
  EXPECT_EQ(bright.exposures, 2);
  double sum = 0;
  int darker = 0, brighter = 0;
  for (std::size_t i = 0; i < whole.flip.error.size(); ++i) {
    const float d = dark.flip.error[i], b = bright.flip.error[i];
    ASSERT_EQ(whole.flip.error[i], std::max(d, b)) << i;
    darker += d > b, brighter += b > d;
    sum += std::max(d, b);
  }
  EXPECT_GT(darker, 10);
  EXPECT_GT(brighter, 10);
  EXPECT_NEAR(whole.flip.mean, sum / (kWidth * kHeight), 1e-12);
}

TEST(HdrFlip, ScalingBothPicturesShiftsTheExposuresAndChangesNothingElse) {
  const Image test = disturbed(many_stops()), reference = many_stops();
  const auto plain = hdr_flip(test, reference, seen_from(24));
  ASSERT_TRUE(plain);
  for (const int stops : {-90, -3, 1, 10, 110}) {
    const auto moved = hdr_flip(scaled(test, stops), scaled(reference, stops), seen_from(24));
    ASSERT_TRUE(moved);
    EXPECT_NEAR(moved->start_exposure, plain->start_exposure - static_cast<float>(stops), 1e-5) << stops;
    EXPECT_NEAR(moved->stop_exposure, plain->stop_exposure - static_cast<float>(stops), 1e-5) << stops;
    EXPECT_EQ(moved->exposures, plain->exposures) << stops;
    // An exposure of 110 stops is a float to 4e-6, so radiance is to 3e-6 of itself; q_c and the feature's root magnify
    // that of small errors, as above.
    for (std::size_t i = 0; i < plain->flip.error.size(); ++i)
      ASSERT_NEAR(moved->flip.error[i], plain->flip.error[i], 3e-4) << stops << " stops, pixel " << i;
    EXPECT_NEAR(moved->flip.mean, plain->flip.mean, 1e-5) << stops;
  }
}

TEST(HdrFlip, ARangeOfWholeStopsIsNotOneExposureMore) {
  Image reference(3, 3);
  for (int i = 1; i <= 100; ++i) {  // so many that some of the logarithms are rounded up
    const float light = 0.37f * static_cast<float>(i);
    std::fill(reference.pixels.begin(), reference.pixels.end(), Color(light));
    reference.at(1, 1) = Color(8 * light);
    ASSERT_EQ(hdr_flip(reference, reference)->exposures, 3) << light;
    reference.at(1, 1) = Color(8.01f * light);
    ASSERT_EQ(hdr_flip(reference, reference)->exposures, 4) << light;
  }
}

TEST(HdrFlip, TheRangeThatItFoundGivesTheSameResultWhenSet) {
  const Image test = disturbed(many_stops()), reference = many_stops();
  const HdrFlipResult found = *hdr_flip(test, reference);
  const auto set = hdr_flip(test, reference, {{}, found.start_exposure, found.stop_exposure});
  ASSERT_TRUE(set);
  EXPECT_EQ(set->flip.error, found.flip.error);
  EXPECT_EQ(set->exposures, found.exposures);
  // One of the two set, the other is still found.
  const auto stop_only = hdr_flip(test, reference, {{}, {}, 1.0f}),
             start_only = hdr_flip(test, reference, {{}, -1.0f, {}});
  ASSERT_TRUE(stop_only && start_only);
  EXPECT_EQ(stop_only->start_exposure, found.start_exposure);
  EXPECT_EQ(stop_only->stop_exposure, 1);
  EXPECT_EQ(start_only->start_exposure, -1);
  EXPECT_EQ(start_only->stop_exposure, found.stop_exposure);
}

TEST(HdrFlip, TheReferenceAloneSaysWhatIsLookedAt) {
  const Image a = disturbed(many_stops()), b = many_stops();
  const auto one = hdr_flip(a, b, seen_from(24)), other = hdr_flip(b, a, seen_from(24));
  ASSERT_TRUE(one && other);
  // From the same Python program.
  EXPECT_NEAR(other->start_exposure, -2.0078351, 1e-6);
  EXPECT_NEAR(other->stop_exposure, 2.3293686, 1e-6);
  EXPECT_NEAR(other->flip.mean, 0.190356109, 1e-5);
  EXPECT_GT(std::abs(one->flip.mean - other->flip.mean), 1e-3);

  const HdrFlipSettings set{{}, -2.0f, 2.0f};
  EXPECT_EQ(hdr_flip(a, b, set)->flip.error, hdr_flip(b, a, set)->flip.error);
}

TEST(HdrFlip, ABlackReferenceIsLookedAtAsTheTest) {
  const Image light = many_stops(), black(kWidth, kHeight);
  const auto found = hdr_flip(light, black), itself = hdr_flip(light, light);
  ASSERT_TRUE(found && itself);
  EXPECT_EQ(found->start_exposure, itself->start_exposure);
  EXPECT_EQ(found->stop_exposure, itself->stop_exposure);
  EXPECT_GT(found->flip.mean, 0.5);

  const auto nothing = hdr_flip(black, black);
  ASSERT_TRUE(nothing);
  EXPECT_EQ(nothing->start_exposure, 0);
  EXPECT_EQ(nothing->stop_exposure, 0);
  EXPECT_EQ(nothing->exposures, 2);
  EXPECT_EQ(nothing->flip.mean, 0);
}

TEST(HdrFlip, NegativeValuesCountAsBlack) {
  Image reference = many_stops(), negative = reference;
  for (std::size_t i = 0; i < reference.pixels.size(); ++i) reference.pixels[i].r = 0, negative.pixels[i].r = -0.1f;
  const Image test = many_stops();
  const auto result = hdr_flip(test, negative), expected = hdr_flip(test, reference);
  ASSERT_TRUE(result && expected);
  EXPECT_EQ(result->start_exposure, expected->start_exposure);
  EXPECT_EQ(result->stop_exposure, expected->stop_exposure);
  EXPECT_EQ(result->flip.error, expected->flip.error);
}

TEST(HdrFlip, RadianceAtTheEndsOfAFloatIsShown) {
  Image reference(4, 4, Color(1e-38f));
  reference.at(1, 1) = Color(3e38f);
  const auto result = hdr_flip(reference, Image(4, 4, Color(1e-38f)), {{4}, -200.0f, 200.0f});
  ASSERT_TRUE(result);
  EXPECT_EQ(result->exposures, 400);
  for (const float error : result->flip.error) ASSERT_TRUE(error >= 0 && error <= 1) << error;
  EXPECT_GT(result->flip.error[5], 0.5);
}

TEST(HdrFlip, InputOutOfRangeIsAnError) {
  const Image image(2, 1, Color(1)), tall(1, 2, Color(1));
  EXPECT_EQ(hdr_flip(image, tall).error().message,
            "found images of 2 x 1 and 1 x 2 pixels, expected the same extents to compare");
  EXPECT_FALSE(hdr_flip(Image(), Image()));
  Image bad = image;
  bad.at(1, 0).g = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(hdr_flip(bad, image).error().message,
            "found a NaN or an infinity in pixel (1, 0) of the test image, expected finite values");
  bad.at(1, 0).g = std::numeric_limits<float>::infinity();
  EXPECT_EQ(hdr_flip(image, bad).error().message,
            "found a NaN or an infinity in pixel (1, 0) of the reference image, expected finite values");
  EXPECT_EQ(hdr_flip(image, image, seen_from(3)).error().message,
            "found 3.000000 pixels per degree, expected 4 to 1000");
  EXPECT_EQ(hdr_flip(image, image, {{}, 2.0f, 2.0f}).error().message,
            "found exposures from 2.000000 to 2.000000 stops, expected the start below the stop (one that is not set "
            "comes from the reference)");
  EXPECT_FALSE(hdr_flip(image, image, {{}, 3.0f, {}}));   // the reference's stop is 1.08
  EXPECT_FALSE(hdr_flip(image, image, {{}, {}, -3.0f}));  // and so is its start
  EXPECT_EQ(hdr_flip(image, image, {{}, -201.0f, 0.0f}).error().message,
            "found an exposure of -201.000000 stops, expected -200 to 200");
  EXPECT_EQ(hdr_flip(image, image, {{}, 0.0f, 201.0f}).error().message,
            "found an exposure of 201.000000 stops, expected -200 to 200");
  EXPECT_EQ(hdr_flip(image, image, {{}, {}, std::numeric_limits<float>::quiet_NaN()}).error().message,
            "found an exposure of nan stops, expected -200 to 200");
}

}  // namespace
}  // namespace brume
