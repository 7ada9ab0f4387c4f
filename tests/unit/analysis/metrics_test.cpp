#include "renderer/analysis/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace brume {
namespace {

/// Two pixels with differences (1, 0, -2) and (0, 0, 4).
Image small_reference() {
  Image image(2, 1);
  image.at(0, 0) = {1, 2, 3};
  image.at(1, 0) = {0, 0, 6};
  return image;
}
Image small_test() {
  Image image(2, 1);
  image.at(0, 0) = {2, 2, 1};
  image.at(1, 0) = {0, 0, 10};
  return image;
}

TEST(Metrics, IdenticalImagesHaveNoError) {
  const Image image = small_reference();
  EXPECT_EQ(*rmse(image, image), 0);
  EXPECT_EQ(*relative_mse(image, image), 0);
  EXPECT_EQ(*mean_bias(image, image), 0);
  EXPECT_EQ(*relative_mean_bias(image, image), 0);
  EXPECT_EQ(*median_of_tiles(image, image), 0);
}

TEST(Metrics, RmseByHand) {
  EXPECT_DOUBLE_EQ(*rmse(small_test(), small_reference()), std::sqrt((1 + 4 + 16) / 6.0));
  EXPECT_EQ(*rmse(small_reference(), small_test()), *rmse(small_test(), small_reference()));
}

TEST(Metrics, RelativeMseByHand) {
  // Only the reference divides: 1 / (1 + e), 4 / (9 + e), 16 / (36 + e).
  EXPECT_DOUBLE_EQ(*relative_mse(small_test(), small_reference(), 0.5), (1 / 1.5 + 4 / 9.5 + 16 / 36.5) / 6);
  EXPECT_DOUBLE_EQ(*relative_mse(small_test(), small_reference()), (1 / 1.01 + 4 / 9.01 + 16 / 36.01) / 6);
}

TEST(Metrics, MeanBiasByHand) {
  EXPECT_DOUBLE_EQ(*mean_bias(small_test(), small_reference()), (1 - 2 + 4) / 6.0);
  EXPECT_DOUBLE_EQ(*mean_bias(small_reference(), small_test()), -(1 - 2 + 4) / 6.0);
  EXPECT_DOUBLE_EQ(*relative_mean_bias(small_test(), small_reference()), 3 / 12.0);
}

TEST(Metrics, RelativeBiasOfABlackReferenceIsAnError) {
  EXPECT_FALSE(relative_mean_bias(small_test(), Image(2, 1)));
  EXPECT_TRUE(mean_bias(small_test(), Image(2, 1)));
}

TEST(Metrics, MedianOfTilesByHand) {
  // Tiles of 2x2 in 5x2: two whole ones with errors 1 and 3, and a narrow one of 1x2 with error 2.
  Image test(5, 2), reference(5, 2);
  for (int y = 0; y < 2; ++y) {
    test.at(0, y) = test.at(1, y) = Color(1);
    test.at(2, y) = test.at(3, y) = Color(3);
    test.at(4, y) = Color(2);
  }
  EXPECT_DOUBLE_EQ(*median_of_tiles(test, reference, 2), 2);
  // One pixel a tile: squared errors 1 1 1 1 4 4 9 9 9 9.
  EXPECT_DOUBLE_EQ(*median_of_tiles(test, reference, 1), 2);
  // Two tiles: 3x2 with (1 + 1 + 9) / 3 and 2x2 with (9 + 4) / 2; the mean of the two is the median.
  EXPECT_DOUBLE_EQ(*median_of_tiles(test, reference, 3), std::sqrt((11 / 3.0 + 13 / 2.0) / 2));
  // One tile is all of it.
  for (const int size : {5, 6, 1000, std::numeric_limits<int>::max()})
    EXPECT_DOUBLE_EQ(*median_of_tiles(test, reference, size), *rmse(test, reference));
}

TEST(Metrics, OneFireflyRulesRmseButNotTheMedian) {
  const Image reference(64, 64, Color(1));
  Image test(64, 64, Color(1.1f));
  const double calm = *rmse(test, reference);
  test.at(10, 20) = Color(1000);
  EXPECT_GT(*rmse(test, reference), 100 * calm);
  EXPECT_NEAR(*median_of_tiles(test, reference), calm, 1e-6);
}

TEST(Metrics, MedianIsThatOfTilesWithLight) {
  // A picture that is three quarters background.
  Image test(8, 8), reference(8, 8);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) test.at(x, y) = Color(3), reference.at(x, y) = Color(1);
  EXPECT_DOUBLE_EQ(*median_of_tiles(test, reference, 4), 2);
  EXPECT_DOUBLE_EQ(*median_of_tiles(test, reference, 2), 2);
  reference.at(7, 7) = Color(1);  // light in one of the images is enough: tiles with errors 2 and 1/4
  EXPECT_DOUBLE_EQ(*median_of_tiles(test, reference, 4), std::sqrt((4 + 1 / 16.0) / 2));
  EXPECT_EQ(*median_of_tiles(Image(8, 8), Image(8, 8)), 0);
}

TEST(Metrics, SumsAreNotRoundedToFloat) {
  // 3 million small values on top of a large one: a float sum would stop at 2^24.
  Image test(1000, 1000, Color(1));
  test.at(0, 0) = Color(33554432);
  EXPECT_DOUBLE_EQ(*mean_bias(test, Image(1000, 1000)), (33554432.0 + 999999) / 1e6);
}

TEST(Metrics, DifferentExtentsAreAnError) {
  const Image wide(2, 1), tall(1, 2);
  const Result<double> result = rmse(wide, tall);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().message, "found images of 2 x 1 and 1 x 2 pixels, expected the same extents to compare");
  EXPECT_FALSE(relative_mse(wide, tall));
  EXPECT_FALSE(mean_bias(wide, tall));
  EXPECT_FALSE(relative_mean_bias(wide, tall));
  EXPECT_FALSE(median_of_tiles(wide, tall));
  EXPECT_FALSE(rmse(Image(), Image()));
  Image inconsistent(2, 1);
  inconsistent.pixels.pop_back();
  EXPECT_FALSE(rmse(wide, inconsistent));
}

TEST(Metrics, NonFinitePixelIsNamed) {
  Image bad(3, 2, Color(1));
  bad.at(2, 1).g = std::numeric_limits<float>::quiet_NaN();
  const Image good(3, 2, Color(1));
  const Result<double> in_test = rmse(bad, good), in_reference = median_of_tiles(good, bad);
  ASSERT_FALSE(in_test);
  ASSERT_FALSE(in_reference);
  EXPECT_EQ(in_test.error().message,
            "found a NaN or an infinity in pixel (2, 1) of the test image, expected finite values");
  EXPECT_NE(in_reference.error().message.find("reference image"), std::string::npos);
}

TEST(Metrics, ParametersOutOfRangeAreErrors) {
  const Image image(1, 1);
  for (const double epsilon : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_FALSE(relative_mse(image, image, epsilon)) << epsilon;
  for (const int size : {0, -3}) EXPECT_FALSE(median_of_tiles(image, image, size)) << size;
}

}  // namespace
}  // namespace brume
