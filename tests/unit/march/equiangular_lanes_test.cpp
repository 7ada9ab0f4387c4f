#include "renderer/march/equiangular_lanes.h"

#include <gtest/gtest.h>

#include <set>

#include "renderer/sampling/sampler.h"
#include "tests/support/simd_levels.h"
#include "tests/support/statistics.h"
#include "tests/unit/march/pivot_placements.h"

namespace brume {
namespace {

const Ray kRay{{0, 0, 0}, {1, 0, 0}};
constexpr int kLanes = static_cast<int>(std::size(kPlacements));

using Row = LaneArray<float>;
static_assert(kLanes <= kWidestVector);

class EquiangularLanesAt : public AtSimdLevel {
 protected:
  /// One lane for each placement, so that no two are alike.
  EquiangularLanesAt() {
    for (int k = 0; k < kLanes; ++k) lanes_.aim(k, pivot(kPlacements[k]), kPlacements[k].span);
  }
  static Vec3 pivot(const Placement& p) { return {static_cast<float>(p.foot), static_cast<float>(p.distance), 0}; }

  EquiangularLanes lanes_;
};

// The share of the span's angle at a sampled distance is the number that drew it, and the density is that of the angle:
// what EquiangularDistribution computes in double, and its test holds against quadrature.
TEST_P(EquiangularLanesAt, SampleInvertsTheAngleAndPdfIsItsDerivative) {
  lanes_.measure(kRay, kLanes);
  for (int i = 0; i < 1000; ++i) {
    Row u, t, pdf;
    for (int k = 0; k < kLanes; ++k) u[k] = (static_cast<float>(i) + 0.5f) / 1000;
    lanes_.sample(u, t);
    lanes_.pdf(t, t, pdf);
    for (int k = 0; k < kLanes; ++k) {
      const Placement& p = kPlacements[k];
      const double foot = double(pivot(p).x), D = double(pivot(p).y);
      const double a = double(p.span.begin) - foot, b = double(p.span.end) - foot, s = double(t[k]) - foot;
      ASSERT_TRUE(t[k] >= p.span.begin && t[k] <= p.span.end) << p.what;
      const double density = D / (angle(a, b, D) * (D * D + s * s));
      // What one float of t is in the angle, and a few roundings of a distance that comes from far away.
      const double rounding = density * 1.2e-7 * double(std::max(1.0f, p.span.end));
      EXPECT_NEAR(angle(a, s, D) / angle(a, b, D), u[k], 2e-6 + 3 * rounding) << p.what;
      EXPECT_NEAR(pdf[k] / density, 1, 4e-6 + 2 * std::abs(s) * 2.4e-7 * std::abs(foot) / (D * D + s * s)) << p.what;
    }
  }
}

TEST_P(EquiangularLanesAt, PartsFarFromThePivotHaveTheMeanDensity) {
  lanes_.measure(kRay, kLanes);
  for (int i = 0; i < 64; ++i) {
    Row begin, end, pdf;
    for (int k = 0; k < kLanes; ++k) {
      const Interval span = kPlacements[k].span;
      const float step = span.length() / 60;  // the last ones stick out
      begin[k] = span.begin + (static_cast<float>(i) - 2) * step, end[k] = begin[k] + step;
    }
    lanes_.pdf(begin, end, pdf);
    for (int k = 0; k < kLanes; ++k) {
      const Placement& p = kPlacements[k];
      if (lanes_.is_near(k, {begin[k], end[k]})) continue;
      const double foot = double(pivot(p).x), D = double(pivot(p).y);
      const double first = std::max(double(begin[k]), double(p.span.begin)),
                   last = std::min(double(end[k]), double(p.span.end));
      const double share = last > first ? angle(first - foot, last - foot, D) /
                                              angle(double(p.span.begin) - foot, double(p.span.end) - foot, D)
                                        : 0;
      const double mean = share / (double(end[k]) - double(begin[k]));
      // A part is a difference of two floats.
      EXPECT_NEAR(pdf[k], mean, mean * (1e-5 + 60 * 1.2e-7 * double(p.span.end) / double(p.span.length()))) << p.what;
    }
  }
}

TEST_P(EquiangularLanesAt, EmptySpansAndPointsOutsideHaveNoDensity) {
  Row outside, pdf;
  for (int k = 0; k < kLanes; ++k) outside[k] = kPlacements[k].span.end * 1.001f;
  lanes_.aim(0, {5, 1, 0}, {3, 3});
  lanes_.aim(1, {5, 1, 0}, {7, 3});
  outside[0] = 3, outside[1] = 5;
  lanes_.measure(kRay, kLanes);
  lanes_.pdf(outside, outside, pdf);
  for (int k = 0; k < kLanes; ++k) EXPECT_EQ(pdf[k], 0) << k;
}

// A5 of the catalogue: differences of nearly equal arctangents would leave a handful of distances.
TEST_P(EquiangularLanesAt, ShortSpansFarFromTheFootKeepTheirDistances) {
  const float far_away[] = {-100, -1000, -10000, -1e6f, 101, 1001, 10001, 1e6f};
  const int n = static_cast<int>(std::size(far_away));
  EquiangularLanes lanes;
  for (int k = 0; k < n; ++k) lanes.aim(k, {far_away[k], 1, 0}, {0, 1});
  lanes.measure(kRay, n);
  std::vector<std::set<float>> distinct(std::size(far_away));
  for (int i = 0; i < 4096; ++i) {
    Row u, t;
    std::fill_n(u.v, n, (static_cast<float>(i) + 0.5f) / 4096);
    lanes.sample(u, t);
    for (int k = 0; k < n; ++k) {
      distinct[static_cast<std::size_t>(k)].insert(t[k]);
      const long double a = -static_cast<long double>(far_away[k]), b = 1 + a;
      const long double theta = static_cast<long double>(u[k]) * std::atan2(b - a, 1 + a * b);
      const long double away = std::tan(theta) * (1 + a * a) / (1 - a * std::tan(theta));
      EXPECT_NEAR(t[k], static_cast<double>(away), 1e-6) << far_away[k];
    }
  }
  for (int k = 0; k < n; ++k) EXPECT_EQ(distinct[static_cast<std::size_t>(k)].size(), 4096u) << far_away[k];
}

// A4 of the catalogue: the density is a delta, 0/0 in the textbook form.
TEST_P(EquiangularLanesAt, PivotsOnTheRayGiveFiniteSamplesOfADensity) {
  const float feet[] = {2.5f, 0, -4, 10};
  EquiangularLanes lanes;
  for (int k = 0; k < 4; ++k) lanes.aim(k, {feet[k], 0, 0}, {0, 10});
  lanes.measure(kRay, 4);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    Row u, t, pdf;
    std::fill_n(u.v, 4, Sampler(SamplerKind::Independent, 6, 1, i).u1(Decision::EquiangularDistance));
    lanes.sample(u, t);
    lanes.pdf(t, t, pdf);
    for (int k = 0; k < 4; ++k)
      EXPECT_TRUE(t[k] >= 0 && t[k] <= 10 && pdf[k] > 0 && std::isfinite(pdf[k])) << feet[k] << ' ' << t[k];
  }
}

TEST_P(EquiangularLanesAt, WorksInAnyDirectionAndFromFarAway) {
  const Ray ray{{1000, -2000, 3000}, normalize(Vec3(2, -1, 2))};
  const Vec3 beside = ray.at(2) + normalize(cross(ray.direction, Vec3(0, 0, 1))) * 0.5f;
  EquiangularLanes lanes;
  lanes.aim(0, beside, {0, 6});
  lanes.measure(ray, 1);
  // Where the pivot really is, after its rounding.
  const Vec3d to_pivot = Vec3d(beside) - Vec3d(ray.origin), d(ray.direction);
  const double foot = dot(to_pivot, d), D = length(to_pivot - d * foot);
  for (int i = 0; i < 100; ++i) {
    Row u, t, pdf;
    u[0] = (static_cast<float>(i) + 0.5f) / 100;
    lanes.sample(u, t);
    lanes.pdf(t, t, pdf);
    const double s = double(t[0]) - foot;
    EXPECT_NEAR(double(pdf[0]) * angle(-foot, 6 - foot, D) / D * (D * D + s * s), 1, 4e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Levels, EquiangularLanesAt, testing::ValuesIn(simd_levels()), simd_level_name);

}  // namespace
}  // namespace brume
