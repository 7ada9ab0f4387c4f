#include "renderer/film/film.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <thread>
#include <vector>

namespace brume {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Mean and variance of the mean by the textbook's two passes, in long double.
struct TwoPass {
  long double mean = 0, variance = 0;
  explicit TwoPass(const std::vector<float>& values) {
    const auto n = static_cast<long double>(values.size());
    for (const float value : values) mean += value / n;
    for (const float value : values) variance += (value - mean) * (value - mean);
    variance /= n * (n - 1);
  }
};

TEST(Film, AgreesWithTwoPassesInHigherPrecision) {
  // A bright pixel with little noise: the sum of squares minus the square of the sum would have no digit left in float.
  std::mt19937 random(7);
  std::normal_distribution<float> noise(0, 0.5f);
  Film film(2, 2);
  std::vector<float> red, green, blue;
  for (int i = 0; i < 5000; ++i) {
    const Color sample{10000 + noise(random), 1 + noise(random), 1e-6f * noise(random)};
    red.push_back(sample.r), green.push_back(sample.g), blue.push_back(sample.b);
    ASSERT_TRUE(film.add_sample(1, 0, sample));
  }
  const TwoPass expected[3] = {TwoPass(red), TwoPass(green), TwoPass(blue)};
  for (int c = 0; c < 3; ++c) {
    // The results are rounded to float once: half a unit in the last place, 6e-8.
    EXPECT_NEAR(film.mean(1, 0)[c], expected[c].mean, 1e-7 * std::abs(static_cast<double>(expected[c].mean)));
    EXPECT_NEAR(film.variance(1, 0)[c], expected[c].variance, 1e-7 * static_cast<double>(expected[c].variance));
  }
  EXPECT_EQ(film.sample_count(1, 0), 5000u);
  EXPECT_EQ(film.sample_count(0, 0), 0u);
}

TEST(Film, VarianceOfConstantSamplesIsZero) {
  Film film(1, 1);
  for (int i = 0; i < 1000; ++i) film.add_sample(0, 0, {0.1f, 123.456f, 1e-20f});
  EXPECT_EQ(film.mean(0, 0), Color(0.1f, 123.456f, 1e-20f));
  EXPECT_EQ(film.variance(0, 0), Color(0));
}

TEST(Film, VarianceOfTheMeanOfTwoSamplesIsAQuarterOfTheirSquaredDistance) {
  // M2 = 2 (d/2)^2 and n (n - 1) = 2.
  Film film(1, 1);
  film.add_sample(0, 0, {1, 2, 0});
  EXPECT_EQ(film.variance(0, 0), Color(0));  // one sample tells nothing
  film.add_sample(0, 0, {3, 2, 4});
  EXPECT_EQ(film.mean(0, 0), Color(2, 2, 2));
  EXPECT_EQ(film.variance(0, 0), Color(1, 0, 4));
}

TEST(Film, NonFiniteSamplesAreDroppedAndLeaveThePixelAsItWas) {
  Film film(1, 1);
  film.add_sample(0, 0, {1, 2, 3});
  film.add_sample(0, 0, {3, 2, 1});
  const Color mean = film.mean(0, 0), variance = film.variance(0, 0);
  for (const Color bad : {Color(kNan, 0, 0), Color(0, kInfinity, 0), Color(0, 0, -kInfinity), Color(kNan)})
    EXPECT_FALSE(film.add_sample(0, 0, bad));
  EXPECT_EQ(film.sample_count(0, 0), 2u);
  EXPECT_EQ(film.mean(0, 0), mean);
  EXPECT_EQ(film.variance(0, 0), variance);
}

TEST(Film, HugeFiniteSamplesStayFinite) {
  Film film(1, 1);
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(film.add_sample(0, 0, Color(i % 2 ? 3e38f : -3e38f)));
  EXPECT_TRUE(is_finite(film.mean(0, 0)));
  EXPECT_TRUE(is_finite(film.variance(0, 0)));
  EXPECT_GT(film.variance(0, 0).r, 1e38f);
}

TEST(Film, ImagesHaveRowZeroAtTheTop) {
  Film film(3, 2);
  film.add_sample(2, 0, Color(1));
  film.add_sample(0, 1, Color(5));
  film.add_sample(0, 1, Color(7));
  const Image mean = film.mean_image(), variance = film.variance_image();
  ASSERT_EQ(mean.width, 3);
  ASSERT_EQ(mean.height, 2);
  EXPECT_EQ(mean.pixels, (std::vector<Color>{{}, {}, Color(1), Color(6), {}, {}}));
  EXPECT_EQ(variance.pixels, (std::vector<Color>{{}, {}, {}, Color(1), {}, {}}));
}

TEST(Film, MeanImageReusesTheMemoryOfItsArgument) {
  Film film(8, 4);
  film.add_sample(7, 3, Color(2));
  Image image(8, 4, Color(9));
  const Color* memory = image.pixels.data();
  film.mean_image(image);
  EXPECT_EQ(image.pixels.data(), memory);
  EXPECT_EQ(image, film.mean_image());
}

TEST(Film, BitsDoNotDependOnTheNumberOfThreads) {
  constexpr int kWidth = 37, kHeight = 23, kPasses = 16;
  const auto fill_row = [](Film& film, int y) {
    for (int x = 0; x < kWidth; ++x) {
      std::mt19937 random(static_cast<unsigned>(y * kWidth + x));
      std::exponential_distribution<float> value(1);
      for (int pass = 0; pass < kPasses; ++pass) film.add_sample(x, y, {value(random), value(random), value(random)});
    }
  };
  Film alone(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) fill_row(alone, y);

  Film shared(kWidth, kHeight);
  std::vector<std::thread> threads;
  constexpr int kThreads = 4;
  for (int first = 0; first < kThreads; ++first)
    threads.emplace_back([&, first] {
      for (int y = first; y < kHeight; y += kThreads) fill_row(shared, y);
    });
  for (std::thread& thread : threads) thread.join();

  EXPECT_EQ(shared.mean_image(), alone.mean_image());
  EXPECT_EQ(shared.variance_image(), alone.variance_image());
}

/// The pixels that have a twin among the first width x height.
std::vector<std::pair<int, int>> twins(int width, int height) {
  std::vector<std::pair<int, int>> found;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (Film::has_twin(x, y)) found.emplace_back(x, y);
  return found;
}

TEST(Film, EveryBlockHasOneTwinAndTheirPlacesAreSpreadOut) {
  std::vector<int> at_place(64);
  for (int by = 0; by < 64; ++by)
    for (int bx = 0; bx < 64; ++bx) {
      int in_block = 0;
      for (int place = 0; place < 64; ++place)
        if (Film::has_twin(8 * bx + place % 8, 8 * by + place / 8)) ++in_block, ++at_place[std::size_t(place)];
      ASSERT_EQ(in_block, 1) << bx << " " << by;
    }
  // 4096 blocks, 64 at each place, standard deviation 8.
  for (const int times : at_place) EXPECT_NEAR(times, 64, 5 * 8);
}

TEST(Film, NoiseEstimateIsThatOfItsDefinition) {
  const auto at = twins(16, 8);
  ASSERT_EQ(at.size(), 2u);
  Film film(16, 8);
  film.add_sample(at[0].first, at[0].second, Color(1));
  film.add_sample(at[0].first, at[0].second, Color(3));
  film.add_twin_sample(at[0].first, at[0].second, Color(5));
  film.add_sample(at[1].first, at[1].second, Color(2));
  film.add_twin_sample(at[1].first, at[1].second, Color(1));
  film.add_twin_sample(at[1].first, at[1].second, Color(2));
  // Differences 3 and 0.5, means 2 and 2.
  EXPECT_NEAR(film.noise_estimate(), std::sqrt(std::numbers::pi) / 2 * 1.75 / 2, 1e-6);
  film.clear();
  EXPECT_EQ(film.noise_estimate(), 0);
}

TEST(Film, NoiseEstimatePredictsTheErrorOfThePicture) {
  // Means of many exponential samples of mean 1 are nearly normal: after n samples the relative noise is 1/sqrt(n).
  std::mt19937 random(3);
  std::exponential_distribution<float> value(1);
  constexpr int kSide = 256, kSamples = 64;
  Film film(kSide, kSide);
  for (const auto& [x, y] : twins(kSide, kSide))
    for (int i = 0; i < kSamples; ++i) {
      film.add_sample(x, y, Color(value(random)));
      film.add_twin_sample(x, y, Color(value(random)));
    }
  // 1024 pairs; |a - b| has a relative deviation of 0.76: 0.024, taken three times.
  EXPECT_NEAR(film.noise_estimate() * std::sqrt(kSamples), 1, 0.072);
}

TEST(Film, NoiseEstimateIsZeroWithoutTwinsOrLight) {
  EXPECT_EQ(Film().noise_estimate(), 0);
  const auto [x, y] = twins(8, 8).front();
  Film film(8, 8);
  EXPECT_EQ(film.noise_estimate(), 0);
  film.add_sample(x, y, Color(1));  // no twin: unknown
  EXPECT_EQ(film.noise_estimate(), 0);
  EXPECT_FALSE(film.add_twin_sample(x, y, Color(std::numeric_limits<float>::quiet_NaN())));
  EXPECT_EQ(film.noise_estimate(), 0);
  Film black(8, 8);
  black.add_sample(x, y, Color(0));
  black.add_twin_sample(x, y, Color(0));
  EXPECT_EQ(black.noise_estimate(), 0);
}

TEST(Film, ClearForgetsSamplesAndResizeExtentsToo) {
  Film film(2, 1);
  film.add_sample(1, 0, Color(4));
  film.add_sample(1, 0, Color(8));
  film.clear();
  EXPECT_EQ(film.width(), 2);
  EXPECT_EQ(film.sample_count(1, 0), 0u);
  EXPECT_EQ(film.mean_image(), Image(2, 1));
  film.add_sample(1, 0, Color(4));
  EXPECT_EQ(film.mean(1, 0), Color(4));
  film.resize(1, 3);
  EXPECT_EQ(film.height(), 3);
  EXPECT_EQ(film.mean_image(), Image(1, 3));
  EXPECT_EQ(film.variance_image(), Image(1, 3));
}

}  // namespace
}  // namespace brume
