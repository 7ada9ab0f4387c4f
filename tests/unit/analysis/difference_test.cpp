#include "renderer/analysis/difference.h"

#include <gtest/gtest.h>

#include "renderer/analysis/flip.h"

namespace brume {
namespace {

using Bytes = std::array<std::uint8_t, 3>;

Bytes at(const DifferenceMap& map, std::size_t i) {
  return {map.image.bytes[4 * i], map.image.bytes[4 * i + 1], map.image.bytes[4 * i + 2]};
}

Image row(const std::vector<float>& values) {
  Image image(static_cast<int>(values.size()), 1);
  for (std::size_t i = 0; i < values.size(); ++i) image.pixels[i] = Color(values[i]);
  return image;
}

TEST(Difference, HasTheColourOfItsValue) {
  const Image test = row({1, 2, 0.5f}), reference = row({1, 1, 1});
  const struct {
    DifferenceKind kind;
    double of[3];
  } expected[] = {{DifferenceKind::Signed, {0, 1, -0.5}},
                  {DifferenceKind::Absolute, {0, 1, 0.5}},
                  {DifferenceKind::Relative, {0, 1 / 1.01, 0.5 / 1.01}},
                  {DifferenceKind::Squared, {0, 1, 0.25}}};
  for (const auto& e : expected) {
    const auto map = difference_map(test, reference, e.kind, 1);
    ASSERT_TRUE(map.ok());
    EXPECT_EQ(map->range, 1);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(at(*map, i)[c], difference_color(e.of[i], e.kind)[c], 2) << int(e.kind) << " " << i;
  }
}

TEST(Difference, SignedIsBlackAtZeroBlueBelowAndRedAbove) {
  EXPECT_EQ(difference_color(0, DifferenceKind::Signed), (Bytes{0, 0, 0}));
  const Bytes low = difference_color(-0.5, DifferenceKind::Signed),
              high = difference_color(0.5, DifferenceKind::Signed);
  EXPECT_GT(low[2], 2 * low[0]);
  EXPECT_GT(high[0], 2 * high[2]);
  EXPECT_EQ(difference_color(7, DifferenceKind::Signed), difference_color(1, DifferenceKind::Signed));
}

TEST(Difference, TheRangeIsRoundAndHoldsAllButAHundredth) {
  std::vector<float> values(1000, 0.03f);
  for (std::size_t i = 0; i < 9; ++i) values[i] = 80;  // fireflies
  const auto map = difference_map(row(values), row(std::vector<float>(1000)), DifferenceKind::Absolute);
  ASSERT_TRUE(map.ok());
  EXPECT_NEAR(map->range, 0.05, 1e-12);
  const auto same = difference_map(row({1, 2}), row({1, 2}), DifferenceKind::Relative);
  ASSERT_TRUE(same.ok());
  EXPECT_GT(same->range, 0);
  EXPECT_EQ(at(*same, 0), heat_color(0));
}

TEST(Difference, WhatIsNotFiniteIsLoudAndOtherSizesAreRefused) {
  const auto map =
      difference_map(row({std::numeric_limits<float>::quiet_NaN(), 1}), row({1, 1}), DifferenceKind::Absolute, 1);
  ASSERT_TRUE(map.ok());
  EXPECT_EQ(at(*map, 0), heat_color(1));
  const auto refused = difference_map(row({1}), row({1, 2}), DifferenceKind::Signed);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("1 x 1 and 2 x 1"), std::string::npos);
}

}  // namespace
}  // namespace brume
