#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "renderer/phase/phase_mix.h"
#include "renderer/phase/rayleigh.h"
#include "renderer/sampling/sampler.h"
#include "tests/support/statistics.h"

namespace brume {
namespace {

constexpr double kPiD = 3.14159265358979323846;
constexpr float kDraineG[] = {-0.999f, -0.6f, -1e-6f, 0, 1e-4f, 0.5f, 0.95f, 0.999f};
constexpr float kDraineAlpha[] = {0, 1, 10, 1000};
constexpr float kDiameters[] = {1.5f, 3, 4.999f, 5, 10, 20, 50};

Vec2 random_pair(std::uint32_t i) { return Sampler(SamplerKind::Independent, 33, 5, i).u2(Decision::PhaseDirection); }

/// 1/sr in double, of 1 - cos and 1 + cos: whichever is small is exact.
using Density = std::function<double(double one_minus, double one_plus)>;

Density henyey_greenstein(double g) {
  return [a = std::abs(g), g](double one_minus, double one_plus) {
    return (1 - a * a) / (4 * kPiD * std::pow((1 - a) * (1 - a) + 2 * a * (g < 0 ? one_plus : one_minus), 1.5));
  };
}

/// Draine 2003, normalised: the second moment of Henyey-Greenstein is (1 + 2 g^2) / 3.
Density draine(double g, double alpha) {
  return [=](double one_minus, double one_plus) {
    const double c = one_minus < 1 ? 1 - one_minus : one_plus - 1;
    return henyey_greenstein(g)(one_minus, one_plus) * (1 + alpha * c * c) / (1 + alpha * (1 + 2 * g * g) / 3);
  };
}

struct Case {
  std::string name;
  std::shared_ptr<const PhaseFunction> phase;
  double front, back;  // asymmetry of the sharpest lobe each way, at least 0
  double alpha;
  Density density;
};

std::vector<Case> all_cases() {
  std::vector<Case> cases{{"Rayleigh", std::make_shared<Rayleigh>(), 0, 0, 1, draine(0, 1)}};
  for (const float g : kDraineG)
    for (const float alpha : kDraineAlpha) {
      const double exact = std::clamp(double(g), -0.9999, 0.9999);
      cases.push_back({"Draine " + std::to_string(g) + ", " + std::to_string(alpha), std::make_shared<Draine>(g, alpha),
                       std::max(0.0, exact), std::max(0.0, -exact), double(alpha), draine(exact, double(alpha))});
    }
  struct Lobes {
    float front, back, share;
  };
  for (const Lobes l :
       {Lobes{0.8f, -0.3f, 0.3f}, {0.95f, -0.95f, 0.5f}, {0.999f, -0.5f, 0.01f}, {0.9f, -0.4f, 0}, {0.9f, -0.999f, 1}})
    cases.push_back({"TwoLobe " + std::to_string(l.front) + ", " + std::to_string(l.back),
                     std::make_shared<TwoLobe>(HenyeyGreenstein(l.front), HenyeyGreenstein(l.back), l.share),
                     double(l.front), -double(l.back), 0, [=](double one_minus, double one_plus) {
                       return (1 - double(l.share)) * henyey_greenstein(double(l.front))(one_minus, one_plus) +
                              double(l.share) * henyey_greenstein(double(l.back))(one_minus, one_plus);
                     }});
  for (const float d : kDiameters) {
    // The fit's parameters are its own matter: here its samples and moments are held against its own value. Rounding
    // the cosine to float moves single nodes of an integral by 2 % at the sharpest peak (50 um), its sum not at all.
    const auto phase = std::make_shared<Droplets>(water_droplets(d));
    cases.push_back({"Droplets " + std::to_string(d), phase, 0.998, 0, 0, [phase](double one_minus, double) {
                       return double(phase->value(static_cast<float>(1 - one_minus)));
                     }});
  }
  return cases;
}

/// Width in 1 - cos over which the sharpest lobe falls by 2^(3/2).
double peak_width(const Case& c) {
  const double g = std::max(c.front, c.back);
  return (1 - g) * (1 - g) / (2 * g + 1e-3);
}

/// Integral over the sphere of f(one_minus, one_plus), with as many nodes in a peak at either pole as in the rest.
double over_sphere(const Density& f) {
  const auto half = [&](bool front) {
    return integrate(
        [&](double s) {
          const double t = std::pow(s, 4);
          return 2 * kPiD * 4 * std::pow(s, 3) * (front ? f(t, 2 - t) : f(2 - t, t));
        },
        0, 1, 2000);
  };
  return half(true) + half(false);
}

TEST(PhaseFamilies, ValueIsThePublishedFormula) {
  for (const Case& c : all_cases()) {
    for (const float cosine : {-1.0f, -0.9999f, -0.8f, -0.1f, 0.0f, 0.3f, 0.99f, 0.999999f, 1.0f}) {
      const double expected = c.density(1 - double(cosine), 1 + double(cosine));
      // Henyey-Greenstein is in float: of its terms 1 - g^2 loses the most.
      const double of_g = 3e-8 / (1 - std::max(c.front, c.back));
      EXPECT_NEAR(double(c.phase->value(cosine)) / expected, 1, 2e-6 + of_g) << c.name << ", cos = " << cosine;
    }
  }
}

TEST(PhaseFamilies, IntegralIsOneAndItsMeanCosineIsTheReportedOne) {
  for (const Case& c : all_cases()) {
    const auto moment = [&](bool with_cosine) {
      return over_sphere([&](double one_minus, double one_plus) {
        const double cosine = one_minus < 1 ? 1 - one_minus : one_plus - 1;
        return double(c.phase->value(static_cast<float>(cosine))) * (with_cosine ? cosine : 1.0);
      });
    };
    // value() is of a cosine rounded to float, which is of second order in (float spacing) / (width of the peak).
    const double tolerance = 3e-6 + 3 * std::pow(6e-8 / peak_width(c), 2);
    EXPECT_NEAR(moment(false), 1, tolerance) << c.name;
    EXPECT_NEAR(moment(true), c.phase->mean_cosine(), tolerance) << c.name;
  }
}

TEST(PhaseFamilies, SampledDirectionsFollowTheDensity) {
  constexpr int kN = 40000, kQuantiles = 24, kAngles = 6;
  // Bins of each half are bounded by the quantiles of its sharpest Henyey-Greenstein lobe, in the distance t = 1 -
  // |cos| from the pole:  t = (1-g)^2 x (2 + 2 g (1-x)) / ((1-g) + 2 g (1-x))^2.
  const auto edges_of = [&](double g) {
    std::vector<double> edges{0};
    for (int k = 1; k < kQuantiles; ++k) {
      const double x = double(k) / kQuantiles, d = (1 - g) + 2 * g * (1 - x);
      const double t = (1 - g) * (1 - g) * x * (2 + 2 * g * (1 - x)) / (d * d);
      if (t < 0.95) edges.push_back(t);
    }
    edges.push_back(1);
    return edges;
  };
  for (const Case& c : all_cases()) {
    const std::vector<double> edges[2] = {edges_of(c.back), edges_of(c.front)};
    const std::size_t back_bins = edges[0].size() - 1, bins = back_bins + edges[1].size() - 1;
    std::vector<double> observed(bins * kAngles), expected;
    for (const bool front : {false, true}) {
      const auto& e = edges[front];
      for (std::size_t k = 0; k + 1 < e.size(); ++k) {
        const double share = integrate(
            [&](double s) {
              const double t = std::pow(s, 4);
              return 2 * kPiD * 4 * std::pow(s, 3) * (front ? c.density(t, 2 - t) : c.density(2 - t, t));
            },
            std::pow(e[k], 0.25), std::pow(e[k + 1], 0.25), 50);
        expected.insert(expected.end(), kAngles, kN * share / kAngles);
      }
    }
    for (std::uint32_t i = 0; i < kN; ++i) {
      const Vec3 w = c.phase->sample({0, 0, 1}, random_pair(i)).direction;
      // 1 - |cos| of a vector that is unit only to rounding, without cancellation near the poles.
      const double s2 = double(w.x) * double(w.x) + double(w.y) * double(w.y),
                   l = std::hypot(double(w.z), std::sqrt(s2));
      const double t = s2 / (l * (l + std::abs(double(w.z))));
      const auto& e = edges[w.z > 0];
      const auto k = static_cast<std::size_t>(std::upper_bound(e.begin() + 1, e.end() - 1, t) - e.begin()) - 1;
      const double angle = std::atan2(double(w.y), double(w.x)) / (2 * kPiD) + 0.5;
      ++observed[((w.z > 0 ? back_bins : 0) + k) * kAngles +
                 std::min<std::size_t>(kAngles - 1, static_cast<std::size_t>(angle * kAngles))];
    }
    EXPECT_GT(chi_square_p_value(observed, expected), kChiSquareSignificance) << c.name;
  }
}

TEST(PhaseFamilies, MeanCosineOfSamplesIsTheReportedOneForEveryIncidentDirection) {
  constexpr int kN = 10000;
  const auto cases = all_cases();
  const double z = sidak_z(1e-3, static_cast<int>(cases.size()) * 3);
  for (const Case& c : cases) {
    for (const Vec3 incident : {Vec3(0, 0, -1), normalize(Vec3(1, -2, 3)), normalize(Vec3(-3, 1, -1e-3f))}) {
      RunningMean mean;
      for (std::uint32_t i = 0; i < kN; ++i) {
        const PhaseSample s = c.phase->sample(incident, random_pair(i));
        ASSERT_NEAR(length(s.direction), 1, 4e-7f) << c.name;
        mean.add(double(dot(incident, s.direction)));
      }
      EXPECT_NEAR(mean.mean(), c.phase->mean_cosine(), z * mean.standard_error() + 1e-6) << c.name;
    }
  }
}

TEST(PhaseFamilies, ReportedDensityIsTheValueOfTheSampledDirection) {
  for (const Case& c : all_cases()) {
    const double a = std::max(c.front, c.back);
    for (std::uint32_t i = 0; i < 2000; ++i) {
      const PhaseSample s = c.phase->sample({0, 0, 1}, random_pair(i));
      // The cosine is known to 2e-7, of which p depends by both of its factors.
      const double from_pole = 1 - std::abs(double(s.direction.z));
      const double conditioning = 2e-7 * (3 * a / ((1 - a) * (1 - a) + 2 * a * from_pole) + std::sqrt(c.alpha));
      ASSERT_NEAR(s.pdf_w / c.phase->value(s.direction.z), 1, 3e-6 + conditioning) << c.name;
    }
  }
}

TEST(PhaseFamilies, AreFiniteAndPositiveAtAndBeyondTheEndsOfTheCosine) {
  for (const Case& c : all_cases()) {
    for (const float cosine : {-1.0001f, -1.0f, 0.0f, 1.0f, 1.0001f}) {
      const float p = c.phase->value(cosine);
      EXPECT_TRUE(std::isfinite(p) && p > 0) << c.name << ", cos = " << cosine;
    }
    EXPECT_EQ(c.phase->value(-1.0001f), c.phase->value(-1)) << c.name;
    EXPECT_EQ(c.phase->value(1.0001f), c.phase->value(1)) << c.name;
  }
}

TEST(PhaseFamilies, EndsOfTheUnitSquareAreFinite) {
  for (const Case& c : all_cases())
    for (const float x : {0.0f, 0x1p-24f, 0x1.fffffep-1f})
      for (const float y : {0.0f, 0x1.fffffep-1f}) {
        const PhaseSample s = c.phase->sample(normalize(Vec3(1, 2, -2)), {x, y});
        EXPECT_NEAR(length(s.direction), 1, 4e-7f) << c.name << ", u = " << x;
        EXPECT_TRUE(std::isfinite(s.pdf_w) && s.pdf_w > 0) << c.name << ", u = " << x;
      }
}

TEST(Draine, WithoutAlphaIsHenyeyGreenstein) {
  for (const float g : kDraineG) {
    const Draine draine(g, 0);
    const HenyeyGreenstein hg(g);
    // One takes g = 0.999 in double, the other its float, which is 1.3e-8 more.
    const double of_g = 4 * 1.3e-8 / (1 - std::abs(double(g)));
    EXPECT_NEAR(draine.mean_cosine(), hg.mean_cosine(), 6e-8);
    for (const float c : {-1.0f, -0.999f, -0.5f, 0.0f, 0.7f, 0.9999f, 1.0f})
      EXPECT_NEAR(draine.value(c) / hg.value(c), 1, 2e-6 + of_g) << "g = " << g << ", cos = " << c;
    for (std::uint32_t i = 0; i < 1000; ++i) {
      const Vec3 a = draine.sample({0, 0, 1}, random_pair(i)).direction;
      const Vec3 b = hg.sample({0, 0, 1}, random_pair(i)).direction;
      // The very same place for the same numbers, in units of the peak's width in angle.
      const double width = 1e-5 * (1 - std::abs(double(g))) + 1e-4 * std::hypot(double(b.x), double(b.y));
      ASSERT_NEAR(a.x, b.x, width) << "g = " << g;
      ASSERT_NEAR(a.y, b.y, width) << "g = " << g;
    }
  }
}

TEST(Draine, WithoutAsymmetryAndWithAlphaOneIsRayleigh) {
  const Draine draine(0, 1);
  EXPECT_EQ(draine.mean_cosine(), 0);
  for (const float c : {-1.0f, -0.6f, 0.0f, 0.2f, 1.0f}) EXPECT_NEAR(draine.value(c) / Rayleigh().value(c), 1, 3e-7);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    // One begins with the forward directions, the other with the backward ones.
    const Vec2 u = random_pair(i);
    const Vec3 a = draine.sample({0, 0, 1}, {1 - u.x, u.y}).direction, b = Rayleigh().sample({0, 0, 1}, u).direction;
    EXPECT_NEAR(a.z, b.z, 1e-6) << i;
  }
}

TEST(Draine, ParameterBeyondTheRangeIsClamped) {
  EXPECT_EQ(Draine(1, 2).value(0.5f), Draine(0.9999, 2).value(0.5f));
  EXPECT_EQ(Draine(-2, 2).value(0.5f), Draine(-0.9999, 2).value(0.5f));
}

TEST(WaterDroplets, TheFitIsContinuousWhereItsRangesMeet) {
  // Both formulas were fitted apart; by hand they differ at 5 um by 6 % in 1 - g of the forward lobe, so 11 % in the
  // height of its peak, and by 6 % in alpha.
  const Droplets below = water_droplets(4.999f), above = water_droplets(5);
  EXPECT_NEAR(below.mean_cosine() / above.mean_cosine(), 1, 0.01);
  for (int i = 0; i <= 100; ++i) {
    const float c = -1 + 0.02f * static_cast<float>(i);
    EXPECT_NEAR(below.value(c) / above.value(c), 1, c > 0.99f ? 0.13 : 0.08) << "cos = " << c;
  }
  // Nor is there a step anywhere else: tan(ln d) of the lower range has its pole at 4.81 um, where it must not show.
  for (double d = 1.5; d < 49.9; d *= 1.001) {
    if (d < 5 && d * 1.001 >= 5) continue;
    const Droplets a = water_droplets(static_cast<float>(d)), b = water_droplets(static_cast<float>(d * 1.001));
    ASSERT_NEAR(a.mean_cosine() / b.mean_cosine(), 1, 1e-3) << d << " um";
    for (const float c : {-1.0f, -0.5f, 0.0f, 0.5f, 0.9f}) ASSERT_NEAR(a.value(c) / b.value(c), 1, 5e-3) << d << " um";
  }
}

TEST(WaterDroplets, ScatterForwardsAsMieTheorySays) {
  // Of water droplets much larger than the wavelength, visible light: 0.8 to 0.9, where 0.85 stands for a usual cloud.
  float previous = 0;
  for (const float d : {5.0f, 7.0f, 10.0f, 20.0f, 50.0f}) {
    const float g = water_droplets(d).mean_cosine();
    EXPECT_TRUE(g > 0.8f && g < 0.9f) << d << " um: " << g;
    EXPECT_GT(g, previous) << "larger droplets scatter more forwards";
    previous = g;
  }
  EXPECT_NEAR(water_droplets(10).mean_cosine(), 0.86, 0.015);
  for (const float d : {5.0f, 20.0f}) {
    // A forward peak, a dark side and a glory: what makes droplets different from one Henyey-Greenstein lobe.
    const Droplets p = water_droplets(d);
    EXPECT_GT(p.value(1), 1e2f * p.value(0.8f));
    EXPECT_GT(p.value(-1), 1.5f * p.value(-0.3f));
  }
}

TEST(WaterDroplets, DiameterBeyondTheRangeIsClamped) {
  EXPECT_EQ(water_droplets(0.1f).value(0.5f), water_droplets(1.5f).value(0.5f));
  EXPECT_EQ(water_droplets(1000).value(0.5f), water_droplets(50).value(0.5f));
}

}  // namespace
}  // namespace brume
