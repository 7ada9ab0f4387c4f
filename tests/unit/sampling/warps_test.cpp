#include "renderer/sampling/warps.h"

#include <gtest/gtest.h>

#include <vector>

#include "renderer/sampling/sampler.h"
#include "tests/support/statistics.h"

namespace brume {
namespace {

TEST(UniformSphere, PointsAreUnitAndUniformInHeightAndAngle) {
  // Equal steps of z and of the angle have equal areas (Archimedes).
  constexpr int kBins = 16, kN = 100000;
  std::vector<double> observed(kBins * kBins), expected(observed.size(), double(kN) / (kBins * kBins));
  for (std::uint32_t i = 0; i < kN; ++i) {
    const Vec3 w = uniform_sphere(Sampler(SamplerKind::Independent, 1, 0, i).u2(Decision::PhaseDirection));
    ASSERT_NEAR(length(w), 1, 4e-7f);
    const double angle = std::atan2(static_cast<double>(w.y), static_cast<double>(w.x)) / (2 * 3.14159265358979) + 0.5;
    const auto row =
        std::min<std::size_t>(kBins - 1, static_cast<std::size_t>((0.5 + 0.5 * static_cast<double>(w.z)) * kBins));
    const auto column = std::min<std::size_t>(kBins - 1, static_cast<std::size_t>(angle * kBins));
    ++observed[row * kBins + column];
  }
  EXPECT_GT(chi_square_p_value(observed, expected), kChiSquareSignificance);
}

TEST(UniformSphere, DensityIntegratesToOne) { EXPECT_FLOAT_EQ(uniform_sphere_pdf() * 4 * kPi, 1); }

TEST(UniformSphere, EndsOfTheUnitSquareAreFinite) {
  for (const float x : {0.0f, 0x1.fffffep-1f})
    for (const float y : {0.0f, 0x1.fffffep-1f}) EXPECT_NEAR(length(uniform_sphere({x, y})), 1, 4e-7f);
}

}  // namespace
}  // namespace brume
