#include <gtest/gtest.h>

#include <vector>

#include "renderer/phase/henyey_greenstein.h"
#include "renderer/phase/isotropic.h"
#include "renderer/phase/registry.h"
#include "renderer/sampling/sampler.h"
#include "renderer/sampling/warps.h"
#include "tests/support/statistics.h"

namespace brume {
namespace {

constexpr float kAnisotropies[] = {-0.999f, -0.95f, -0.5f, -1e-3f, -1e-6f, 0, 1e-8f, 1e-4f, 0.3f, 0.8f, 0.95f, 0.999f};
constexpr double kTwoPi = 2 * 3.14159265358979323846;

Vec2 random_pair(std::uint32_t i) { return Sampler(SamplerKind::Independent, 21, 3, i).u2(Decision::PhaseDirection); }

/// 1 - |cos| of the angle between the z axis and w, without the cancellation near the axis.
double one_minus_abs_cos(Vec3 w) {
  const double s2 = double(w.x) * double(w.x) + double(w.y) * double(w.y), c = std::abs(double(w.z));
  return s2 / (std::sqrt(s2 + c * c) * (std::sqrt(s2 + c * c) + c));
}

/// Share of the light that HG sends into cosines above 1 - m. Integral of the phase function in closed form, written
/// for m so that the peak is resolved:  (1 - g^2) / (2 g) (1/(1-g) - 1/sqrt((1-g)^2 + 2 g m)), and m/2 for g = 0.
double forward_share(double g, double m) {
  if (std::abs(g) < 1e-9) return 0.5 * m;
  const double q0 = 1 - g, q = std::sqrt(q0 * q0 + 2 * g * m);
  // 1/q0 - 1/q = (q^2 - q0^2) / (q0 q (q + q0)) = 2 g m / (q0 q (q + q0)).
  return (1 - g * g) * m / (q0 * q * (q + q0));
}

TEST(HenyeyGreenstein, SampledDirectionsFollowTheDensity) {
  constexpr int kN = 200000, kCosines = 40, kAngles = 8;
  for (const float g : kAnisotropies) {
    const HenyeyGreenstein phase(g);
    std::vector<double> observed(kCosines * kAngles), expected(observed.size(), double(kN) / (kCosines * kAngles));
    for (std::uint32_t i = 0; i < kN; ++i) {
      const Vec3 w = phase.sample({0, 0, 1}, random_pair(i)).direction;
      const double small = one_minus_abs_cos(w), m = w.z > 0 ? small : 2 - small;
      // Equal shares of the light, by the closed form. For g < 0 the peak is behind: mirrored, its shares are resolved.
      const double share =
          g < 0 ? 1 - forward_share(-double(g), w.z > 0 ? 2 - small : small) : forward_share(double(g), m);
      const double angle = std::atan2(double(w.y), double(w.x)) / kTwoPi + 0.5;
      const auto row = std::min<std::size_t>(kCosines - 1, static_cast<std::size_t>(std::max(0.0, share) * kCosines));
      ++observed[row * kAngles + std::min<std::size_t>(kAngles - 1, static_cast<std::size_t>(angle * kAngles))];
    }
    EXPECT_GT(chi_square_p_value(observed, expected), kChiSquareSignificance) << "g = " << g;
  }
}

TEST(HenyeyGreenstein, IntegralIsOneAndMeanCosineIsG) {
  for (const float g : kAnisotropies) {
    const HenyeyGreenstein phase(g);
    // Over s with 1 - cos = 2 s^4 (or 1 + cos, for backward peaks): the peak has as many nodes as the rest. The
    // argument is rounded to float before value() sees it; that is of second order in (float spacing) / (width of the
    // peak).
    const auto moment = [&](bool with_cosine) {
      return integrate(
          [&](double s) {
            const double m = 2 * std::pow(s, 4), c = (g < 0 ? -1 : 1) * (1 - m);
            return kTwoPi * double(phase.value(static_cast<float>(c))) * (with_cosine ? c : 1.0) * 8 * std::pow(s, 3);
          },
          0, 1, 20000);
    };
    const double width = std::pow(1 - std::abs(double(g)), 2) / (2 * std::abs(double(g)) + 1e-3);
    const double tolerance = 2e-6 + 3 * std::pow(6e-8 / width, 2);
    EXPECT_NEAR(moment(false), 1, tolerance) << "g = " << g;
    EXPECT_NEAR(moment(true), g, tolerance) << "g = " << g;
    EXPECT_FLOAT_EQ(phase.mean_cosine(), g);
  }
}

TEST(HenyeyGreenstein, MeanCosineOfSamplesIsGForEveryIncidentDirection) {
  constexpr int kN = 20000;
  const double z = sidak_z(1e-3, static_cast<int>(std::size(kAnisotropies)) * 6);
  for (const float g : kAnisotropies) {
    const HenyeyGreenstein phase(g);
    for (const Vec3 incident : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(0, -1, 0), normalize(Vec3(1, -2, 3)),
                                normalize(Vec3(-3, 1, -1e-3f))}) {
      RunningMean mean;
      for (std::uint32_t i = 0; i < kN; ++i) {
        const PhaseSample s = phase.sample(incident, random_pair(i));
        ASSERT_NEAR(length(s.direction), 1, 4e-7f);
        mean.add(double(dot(incident, s.direction)));
      }
      EXPECT_NEAR(mean.mean(), g, z * mean.standard_error() + 1e-6) << "g = " << g;
    }
  }
}

TEST(HenyeyGreenstein, ReportedDensityIsTheValueOfTheSampledDirection) {
  for (const float g : kAnisotropies) {
    const HenyeyGreenstein phase(g);
    for (std::uint32_t i = 0; i < 2000; ++i) {
      const PhaseSample s = phase.sample({0, 0, 1}, random_pair(i));
      // p depends on 1 - cos, which is known to 2e-7 (some units of the last place of a cosine near 1): relative error
      // 3/2 * 2 g 2e-7 / denominator.
      const double a = std::abs(double(g)), c = (g < 0 ? -1 : 1) * double(s.direction.z);
      const double conditioning = 3 * a * 2e-7 / ((1 - a) * (1 - a) + 2 * a * (1 - c));
      EXPECT_NEAR(s.pdf_w / phase.value(s.direction.z), 1, 3e-6 + conditioning) << "g = " << g;
    }
  }
}

TEST(HenyeyGreenstein, IsFiniteAndPositiveAtAndBeyondTheEndsOfTheCosine) {
  for (const float g : kAnisotropies)
    for (const float c : {-1.0001f, -1.0f, 0.0f, 1.0f, 1.0001f}) {
      const float p = HenyeyGreenstein(g).value(c);
      EXPECT_TRUE(std::isfinite(p) && p > 0) << "g = " << g << ", cos = " << c;
    }
  // Forward peak in closed form: (1 + g) / (4 pi (1 - g)^2).
  EXPECT_NEAR(HenyeyGreenstein(0.999f).value(1), 1.999 / (2 * kTwoPi * 1e-6), 1e3);  // 1 - g is known to 6e-5 in float
  EXPECT_EQ(HenyeyGreenstein(-0.999f).value(-1), HenyeyGreenstein(0.999f).value(1));
}

TEST(HenyeyGreenstein, EndsOfTheUnitSquareAreForwardAndBackwardDirections) {
  for (const float g : kAnisotropies) {
    for (const float u : {0.0f, 0x1.fffffep-1f}) {
      const PhaseSample s = HenyeyGreenstein(g).sample(normalize(Vec3(1, 2, -2)), {u, 0.3f});
      EXPECT_TRUE(is_finite(s.direction) && std::isfinite(s.pdf_w)) << "g = " << g << ", u = " << u;
    }
  }
}

TEST(HenyeyGreenstein, ParameterBeyondTheRangeIsClamped) {
  EXPECT_EQ(HenyeyGreenstein(1).value(0.5f), HenyeyGreenstein(0.9999).value(0.5f));
  EXPECT_EQ(HenyeyGreenstein(-2).value(0.5f), HenyeyGreenstein(-0.9999).value(0.5f));
}

TEST(HenyeyGreenstein, WithoutAnisotropyIsIsotropic) {
  for (const float g : {0.0f, 1e-8f})
    for (const float c : {-1.0f, 0.2f, 1.0f}) EXPECT_FLOAT_EQ(HenyeyGreenstein(g).value(c), Isotropic().value(c));
}

TEST(Isotropic, SampledDirectionsFollowTheDensity) {
  constexpr int kN = 100000, kBins = 16;
  std::vector<double> observed(kBins * kBins), expected(observed.size(), double(kN) / (kBins * kBins));
  for (std::uint32_t i = 0; i < kN; ++i) {
    const PhaseSample s = Isotropic().sample(normalize(Vec3(1, 1, 1)), random_pair(i));
    EXPECT_FLOAT_EQ(s.pdf_w, Isotropic().value(0.3f));
    const double angle = std::atan2(double(s.direction.y), double(s.direction.x)) / kTwoPi + 0.5;
    ++observed[std::min<std::size_t>(kBins - 1, static_cast<std::size_t>((0.5 + 0.5 * double(s.direction.z)) * kBins)) *
                   kBins +
               std::min<std::size_t>(kBins - 1, static_cast<std::size_t>(angle * kBins))];
  }
  EXPECT_GT(chi_square_p_value(observed, expected), kChiSquareSignificance);
}

/// Every phase function that a scene file can name, also those to come: its sample, its density and its mean cosine
/// agree, whatever its parameters' defaults are.
TEST(PhaseRegistry, EveryKindMadeFromItsDefaultsIsNormalisedAndSamplesItsOwnDensity) {
  for (const PhaseType& type : phase_types()) {
    const auto phase = type.make(Node(*type.table));
    ASSERT_NE(phase, nullptr);
    // Over s with 1 - cos = 2 s^4, so that a forward peak has as many nodes as the rest.
    const auto at = [](double c) { return std::pow(0.5 * (1 - c), 0.25); };
    const auto integral = [&](double low, double high, bool with_cosine) {
      return integrate(
          [&](double s) {
            const double c = 1 - 2 * std::pow(s, 4);
            return kTwoPi * double(phase->value(static_cast<float>(c))) * (with_cosine ? c : 1.0) * 8 * std::pow(s, 3);
          },
          at(high), at(low), 2000);
    };
    EXPECT_NEAR(integral(-1, 1, false), 1, 1e-5) << type.table->key;
    EXPECT_NEAR(integral(-1, 1, true), phase->mean_cosine(), 1e-5) << type.table->key;
    constexpr int kBins = 32, kN = 50000;
    std::vector<double> observed(kBins), expected;
    for (int b = 0; b < kBins; ++b)
      expected.push_back(kN * integral(-1 + 2.0 * b / kBins, -1 + 2.0 * (b + 1) / kBins, false));
    const Vec3 incident = normalize(Vec3(2, -1, 0.5f));
    for (std::uint32_t i = 0; i < kN; ++i) {
      const PhaseSample s = phase->sample(incident, random_pair(i));
      const double c = double(dot(incident, s.direction));
      ++observed[static_cast<std::size_t>(std::clamp(int((0.5 + 0.5 * c) * kBins), 0, kBins - 1))];
    }
    EXPECT_GT(chi_square_p_value(observed, expected), kChiSquareSignificance) << type.table->key;
  }
}

TEST(PhaseRegistry, ParametersReachThePhaseFunction) {
  Node node(*phase_family().find("henyey_greenstein"));
  ASSERT_TRUE(node.set("g", 0.4).ok());
  EXPECT_FLOAT_EQ(make_phase(node)->mean_cosine(), 0.4f);
  EXPECT_EQ(make_phase(Node(*phase_family().find("isotropic")))->mean_cosine(), 0);
}

}  // namespace
}  // namespace brume
