#include "renderer/film/film.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
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
  EXPECT_EQ(film.noise_estimate(), 0);
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
  EXPECT_EQ(shared.noise_estimate(), alone.noise_estimate());
}

TEST(Film, NoiseEstimateIsThatOfItsDefinition) {
  // Variances of the mean 1 and 4, means 2 and 3: ((1 + 2) / 2) / ((2 + 3) / 2) = 0.6.
  Film film(2, 1);
  film.add_sample(0, 0, Color(1));
  film.add_sample(0, 0, Color(3));
  film.add_sample(1, 0, Color(1));
  film.add_sample(1, 0, Color(5));
  EXPECT_NEAR(film.noise_estimate(), 0.6, 1e-6);
}

TEST(Film, NoiseEstimateKnowsThatChannelsAreCorrelated) {
  // Red up while green goes down by the ratio of their weights: the luminance does not change at all.
  Film opposed(1, 1), together(1, 1);
  const float step = 0.2126f / 0.7152f;
  opposed.add_sample(0, 0, {2, 1, 1});
  opposed.add_sample(0, 0, {1, 1 + step, 1});
  together.add_sample(0, 0, {1, 1, 1});
  together.add_sample(0, 0, {2, 1 + step, 1});
  EXPECT_NEAR(opposed.variance(0, 0).r, together.variance(0, 0).r, 1e-7f);
  EXPECT_NEAR(opposed.noise_estimate(), 0, 1e-7);
  EXPECT_GT(together.noise_estimate(), 0.1);
}

TEST(Film, NoiseEstimatePredictsTheErrorOfThePicture) {
  // Exponential samples of mean 1 have variance 1: after n samples the relative noise is 1/sqrt(n).
  std::mt19937 random(3);
  std::exponential_distribution<float> value(1);
  constexpr int kSide = 64;
  Film film(kSide, kSide);
  for (const int samples : {16, 64}) {
    film.clear();
    for (int i = 0; i < samples; ++i)
      for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) film.add_sample(x, y, Color(value(random)));
    // The root of a sample variance is low by (kurtosis 9 - 1) / (8 n) on average (delta method, first order), so the
    // estimate approaches 1 from below as 1 - 1/n. Its own deviation: sqrt(8 / n) / 2 / sqrt(4096) <= 0.0055, four
    // times that, and 0.02 for the terms of higher order.
    EXPECT_NEAR(film.noise_estimate() * std::sqrt(samples), 1 - 1.0 / samples, 0.042) << samples;
  }
}

TEST(Film, NoiseEstimateIsZeroWithoutSamplesOrLight) {
  Film film(2, 1);
  EXPECT_EQ(film.noise_estimate(), 0);
  EXPECT_EQ(Film().noise_estimate(), 0);
  film.add_sample(0, 0, Color(1));  // one sample: unknown
  EXPECT_EQ(film.noise_estimate(), 0);
  Film black(1, 1);
  black.add_sample(0, 0, Color(-1));
  black.add_sample(0, 0, Color(1));
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
