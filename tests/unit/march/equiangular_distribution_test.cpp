#include "renderer/march/equiangular_distribution.h"

#include <gtest/gtest.h>

#include <set>

#include "renderer/sampling/sampler.h"
#include "tests/support/mis_weight.h"
#include "tests/support/statistics.h"
#include "tests/unit/march/pivot_placements.h"

namespace brume {
namespace {

const Ray kRay{{0, 0, 0}, {1, 0, 0}};

float random_number(std::uint32_t i) {
  return Sampler(SamplerKind::Independent, 6, 1, i).u1(Decision::EquiangularDistance);
}

EquiangularDistribution sampling_of(const Placement& s) {
  return {kRay, {static_cast<float>(s.foot), static_cast<float>(s.distance), 0}, s.span};
}

TEST(Equiangular, SampledDistancesFollowTheDensity) {
  constexpr int kN = 100000, kBins = 50;
  for (const Placement& s : kPlacements) {
    const EquiangularDistribution sampling = sampling_of(s);
    // Cells of equal probability, by the closed form of the CDF (an angle), in double.
    const double foot = double(static_cast<float>(s.foot)), D = double(static_cast<float>(s.distance));
    const double a = double(s.span.begin) - foot, b = double(s.span.end) - foot;
    std::vector<double> observed(kBins), expected(kBins, double(kN) / kBins);
    int on_a_border = 0;
    for (std::uint32_t i = 0; i < kN; ++i) {
      const DistanceSample drawn = sampling.sample(random_number(i));
      ASSERT_TRUE(drawn.t >= s.span.begin && drawn.t <= s.span.end) << s.what;
      const double share = angle(a, std::clamp(double(drawn.t) - foot, a, b), D) / angle(a, b, D) * kBins;
      // Near the pivot one float of t is a noticeable angle; a sample then counts for either cell.
      const double step = kBins * D * 2.4e-7 * double(std::max(1.0f, s.span.end)) /
                          ((D * D + std::pow(double(drawn.t) - foot, 2)) * angle(a, b, D));
      if (step > 0.02) ++on_a_border;
      ++observed[static_cast<std::size_t>(std::clamp(static_cast<int>(share), 0, kBins - 1))];
    }
    // With D = 1e-6 floats of t are 0.2 D apart: the histogram shows the floats, not the density.
    if (on_a_border > kN / 50) continue;
    EXPECT_GT(chi_square_p_value(observed, expected), kChiSquareSignificance) << s.what;
  }
}

TEST(Equiangular, DensityIntegratesToOneAndIsThatOfTheSample) {
  for (const Placement& s : kPlacements) {
    const EquiangularDistribution sampling = sampling_of(s);
    const double foot = double(static_cast<float>(s.foot)), D = double(static_cast<float>(s.distance));
    // Over the angle, in which the density is flat: t = foot + D tan(theta).
    const double first = std::atan2(double(s.span.begin) - foot, D), last = std::atan2(double(s.span.end) - foot, D);
    const double spacing = 1.2e-7 * double(s.span.end) / D;  // of floats t, in units of D
    if (spacing < 1e-3 && D < 1e3 && std::abs(foot) < 100) {
      const double sum = integrate(
          [&](double theta) {
            const double c = std::cos(theta),
                         t = std::clamp(foot + D * std::tan(theta), double(s.span.begin), double(s.span.end));
            return double(sampling.pdf(static_cast<float>(t))) * D / (c * c);
          },
          first, last, 4000);
      EXPECT_NEAR(sum, 1, 1e-4) << s.what;
    }
    for (std::uint32_t i = 0; i < 500; ++i) {
      const DistanceSample drawn = sampling.sample(random_number(i));
      ASSERT_GT(drawn.pdf_t, 0) << s.what;
      const double u = double(drawn.t) - foot,
                   exact = D / (angle(double(s.span.begin) - foot, double(s.span.end) - foot, D) * (D * D + u * u));
      // The sample's density is that of the unrounded distance: it differs by what half a float of t does.
      const double rounding = 2 * std::abs(u) * 1.2e-7 * double(s.span.end) / (D * D + u * u);
      EXPECT_NEAR(drawn.pdf_t / exact, 1, 2e-6 + rounding + spacing * spacing) << s.what;
      EXPECT_NEAR(sampling.pdf(drawn.t) / exact, 1, 2e-6) << s.what;
    }
  }
}

TEST(Equiangular, DensityIsZeroOutsideTheSpan) {
  const EquiangularDistribution sampling(kRay, {5, 1, 0}, {2, 8});
  EXPECT_EQ(sampling.pdf(1.999f), 0);
  EXPECT_EQ(sampling.pdf(8.001f), 0);
  EXPECT_GT(sampling.pdf(2), 0);
  EXPECT_GT(sampling.pdf(8), 0);
}

// A4 of the catalogue: the density is a delta, 0/0 in the textbook form.
TEST(Equiangular, PivotOnTheRayGivesFiniteSamplesThatAgreeWithTheDensity) {
  for (const Interval span : {Interval{0, 10}, Interval{3, 10}, Interval{0, 2}, Interval{2.5f, 10}})
    for (const float x : {2.5f, 0.0f, -4.0f, 10.0f}) {
      const EquiangularDistribution sampling(kRay, {x, 0, 0}, span);
      RunningMean total;  // of 1/(pdf), the length of the span
      for (std::uint32_t i = 0; i < 4000; ++i) {
        const DistanceSample drawn = sampling.sample(random_number(i));
        ASSERT_TRUE(std::isfinite(drawn.t) && std::isfinite(drawn.pdf_t) && drawn.pdf_t > 0);
        ASSERT_TRUE(drawn.t >= span.begin && drawn.t <= span.end);
        if (x < span.begin || x > span.end) total.add(1 / double(drawn.pdf_t));
      }
      // With the pivot outside the span the weights are tame and the mean of 1/pdf is the length.
      if (total.count() > 0) {
        EXPECT_NEAR(total.mean(), span.length(), 5 * total.standard_error() + 1e-4);
      }
    }
}

// A5 of the catalogue: short spans far from the foot. Differences of nearly equal arctangents leave 848, 9, 1 distinct
// distances out of 4096 at 100, 1000, 10000 from the foot; the form that is used must keep them all.
TEST(Equiangular, ShortSpansFarFromTheFootKeepAllTheirDistances) {
  for (const bool behind : {false, true})
    for (const float delta : {100.0f, 1000.0f, 10000.0f, 1e6f}) {
      // The ray begins near the span: only the foot is far away.
      const Interval span{0, 1};
      const EquiangularDistribution sampling(kRay, {behind ? -delta : 1 + delta, 1, 0}, span);
      std::set<float> distinct;
      double worst = 0;
      for (int i = 0; i < 4096; ++i) {
        const double u = (i + 0.5) / 4096;
        const DistanceSample drawn = sampling.sample(static_cast<float>(u));
        distinct.insert(drawn.t);
        // Exact inverse in long double: a difference of cotangents.
        const long double foot = behind ? -static_cast<long double>(delta) : 1 + static_cast<long double>(delta);
        const long double a = -foot, b = 1 - foot, near = a > 0 ? a : -b;
        const long double total = std::atan2(b - a, 1 + a * b),
                          tangent = std::tan(static_cast<long double>(static_cast<float>(u)) * total);
        const long double away = near + tangent * (1 + near * near) / (1 - near * tangent);
        worst = std::max(
            worst, static_cast<double>(std::abs((a > 0 ? away : -away) + foot - static_cast<long double>(drawn.t))));
      }
      EXPECT_EQ(distinct.size(), 4096u) << "foot at distance " << delta;
      EXPECT_LT(worst, 2e-7) << "foot at distance " << delta;
    }
}

TEST(Equiangular, APivotOneMillionthFromTheRayIsResolved) {
  // Foot inside: half of all samples lie within D of the foot, whose position is exact here.
  const EquiangularDistribution sampling({{-0.5f, 0, 0}, {1, 0, 0}}, {-0.5f, 1e-6f, 0}, {0, 1});
  int close = 0;
  std::set<float> distinct;
  for (std::uint32_t i = 0; i < 4096; ++i) {
    const float t = sampling.sample((static_cast<float>(i) + 0.5f) / 4096).t;
    close += t < 1e-6f;
    distinct.insert(t);
  }
  EXPECT_NEAR(close, 2048, 2);  // a quarter turn out of (almost) a quarter turn of pi/2: atan(1) / atan(1e6) = 1/2
  EXPECT_EQ(distinct.size(), 4096u);
}

// O3 of the catalogue: the airlight integral of 1/r^2 by one sample, without variance.
TEST(Equiangular, IntegralOfTheInverseSquareHasNoVariance) {
  for (const Placement& s : kPlacements) {
    if (s.distance < 1e-2) continue;  // floats of t are too coarse next to the light; see the render tests for those
    const EquiangularDistribution sampling = sampling_of(s);
    const double foot = double(static_cast<float>(s.foot)), D = double(static_cast<float>(s.distance));
    const double exact = angle(double(s.span.begin) - foot, double(s.span.end) - foot, D) / D;
    for (std::uint32_t i = 0; i < 1000; ++i) {
      const DistanceSample drawn = sampling.sample(random_number(i));
      const double u = double(drawn.t) - foot,
                   rounding = 2 * std::abs(u) * 1.2e-7 * double(s.span.end) / (D * D + u * u);
      EXPECT_NEAR(1 / (D * D + u * u) / double(drawn.pdf_t) / exact, 1, 2e-6 + rounding) << s.what;
    }
  }
}

TEST(Equiangular, WorksInAnyDirectionAndFromAnyOrigin) {
  const Ray ray{{1, -2, 3}, normalize(Vec3(2, -1, 2))};
  const Vec3 beside = ray.at(2) + normalize(cross(ray.direction, Vec3(0, 0, 1))) * 0.5f;
  const EquiangularDistribution sampling(ray, beside, {0, 6});
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const DistanceSample drawn = sampling.sample(random_number(i));
    const double r2 = double(length_squared(ray.at(drawn.t) - beside));
    EXPECT_NEAR(1 / r2 / double(drawn.pdf_t) / (angle(-2, 4, 0.5) / 0.5), 1, 2e-5);
  }
}

// ---- Multiple importance sampling -----------------------------------------------------------------------------------

TEST(MisWeight, WeightsOfBothTechniquesAddToOne) {
  for (const MisHeuristic heuristic : {MisHeuristic::Balance, MisHeuristic::Power})
    for (const float a : {1e-30f, 1e-3f, 0.7f, 1.0f, 3.0f, 1e25f, 1e38f})
      for (const float b : {1e-30f, 1e-3f, 0.7f, 1.0f, 3.0f, 1e25f, 1e38f})
        EXPECT_NEAR(mis_weight(heuristic, a, b) + mis_weight(heuristic, b, a), 1, 2e-7f) << a << ' ' << b;
}

TEST(MisWeight, IsTheHeuristicOfVeachAndGuibas) {
  EXPECT_FLOAT_EQ(mis_weight(MisHeuristic::Balance, 3, 1), 0.75f);
  EXPECT_FLOAT_EQ(mis_weight(MisHeuristic::Balance, 1, 3), 0.25f);
  EXPECT_FLOAT_EQ(mis_weight(MisHeuristic::Power, 3, 1), 0.9f);
  EXPECT_FLOAT_EQ(mis_weight(MisHeuristic::Power, 1, 3), 0.1f);
  EXPECT_EQ(mis_weight(MisHeuristic::Power, 1, 0), 1);
  EXPECT_EQ(mis_weight(MisHeuristic::Power, 0, 1), 0);
  EXPECT_EQ(mis_weight(MisHeuristic::Power, 0, 0), 0);
}

// E3 of the catalogue: squares of densities above 1.8e19 overflow.
TEST(MisWeight, HugeDensitiesDoNotOverflow) {
  EXPECT_FLOAT_EQ(mis_weight(MisHeuristic::Power, 1e30f, 1e30f), 0.5f);
  EXPECT_FLOAT_EQ(mis_weight(MisHeuristic::Power, 3e38f, 1e38f), 0.9f);
  EXPECT_EQ(mis_weight(MisHeuristic::Power, 1e-30f, 1e30f), 0);
}

}  // namespace
}  // namespace brume
