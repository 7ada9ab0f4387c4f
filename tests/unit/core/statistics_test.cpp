// The yardsticks of the other tests: a tail that is too large would let everything pass.
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

#include "renderer/sampling/sampler.h"

namespace brume {
namespace {

TEST(Statistics, ChiSquareTailsAreThoseOfTheTables) {
  // Abramowitz & Stegun 1964, table 26.8.
  EXPECT_NEAR(chi_square_upper_tail(3.84146, 1), 0.05, 1e-6);
  EXPECT_NEAR(chi_square_upper_tail(18.3070, 10), 0.05, 1e-6);
  EXPECT_NEAR(chi_square_upper_tail(124.342, 100), 0.05, 1e-5);
  EXPECT_NEAR(chi_square_upper_tail(2.55821, 10), 0.99, 1e-6);
  EXPECT_NEAR(chi_square_upper_tail(10.828, 1), 0.001, 1e-6);
  EXPECT_NEAR(chi_square_upper_tail(4, 2) / std::exp(-2.0), 1, 1e-12);  // two degrees: exp(-x/2)
  EXPECT_NEAR(chi_square_upper_tail(200, 2) / std::exp(-100.0), 1, 1e-10);
  EXPECT_EQ(chi_square_upper_tail(0, 5), 1);
}

TEST(Statistics, NormalQuantilesAndTheBoundOfSidakAreThoseOfTheTables) {
  EXPECT_NEAR(normal_upper_quantile(0.025), 1.959963985, 1e-8);
  EXPECT_NEAR(normal_upper_quantile(0.5), 0, 1e-12);
  EXPECT_NEAR(normal_upper_quantile(1e-9), 5.997807015, 1e-8);
  EXPECT_NEAR(sidak_z(0.05, 1), 1.959963985, 1e-8);
  EXPECT_NEAR(sidak_z(0.05, 10), 2.7995, 1e-3);
}

TEST(Statistics, ChiSquareTestFindsADensityThatIsWrongByAFewPerCent) {
  std::vector<double> observed(16), expected(16, 100000.0 / 16), wrong(16);
  for (std::uint32_t i = 0; i < 100000; ++i)
    ++observed[static_cast<std::size_t>(Sampler(SamplerKind::Independent, 1, 0, i).u1(Decision::Roulette) * 16)];
  for (std::size_t i = 0; i < 16; ++i) wrong[i] = expected[i] * (i < 8 ? 1.03 : 0.97);
  EXPECT_GT(chi_square_p_value(observed, expected), kChiSquareSignificance);
  EXPECT_LT(chi_square_p_value(observed, wrong), 1e-10);
  expected[3] = 0;
  EXPECT_EQ(chi_square_p_value(observed, expected), 0) << "values where the density is 0";
}

TEST(Statistics, RunningMeanKeepsItsDigitsOnALargeOffset) {
  RunningMean m;
  for (const double x : {4.0, 7.0, 13.0, 16.0}) m.add(1e9 + x);
  EXPECT_EQ(m.mean(), 1e9 + 10);
  EXPECT_EQ(m.variance(), 30);
  EXPECT_DOUBLE_EQ(m.standard_error(), std::sqrt(30.0 / 4));
}

TEST(Statistics, QuadratureIsExactForPolynomialsOfDegreeNine) {
  EXPECT_NEAR(integrate([](double x) { return 10 * std::pow(x, 9); }, 0, 2, 1), 1024, 1e-10);
  EXPECT_NEAR(integrate([](double x) { return std::exp(x); }, 0, 1, 4), std::exp(1.0) - 1, 1e-14);
}

TEST(Statistics, CorrelationOfAFunctionWithItselfIsOneAndWithItsMirrorMinusOne) {
  const std::vector<double> a{1, 2, 4, 8}, b{-1, -2, -4, -8};
  EXPECT_DOUBLE_EQ(correlation(a, a), 1);
  EXPECT_DOUBLE_EQ(correlation(a, b), -1);
}

}  // namespace
}  // namespace brume
