#include "renderer/march/attenuation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/sampling/sampler.h"
#include "tests/support/simd_levels.h"

namespace brume {
namespace {

class Attenuation : public AtSimdLevel {
 protected:
  /// Values of every size, some of them 0, and whatever behind them.
  static std::vector<float> rough_values(int n) {
    std::vector<float> values;
    for (int i = 0; i < n + 2 * kWidestVector; ++i) {
      const Sampler s(SamplerKind::Independent, 3, static_cast<std::uint32_t>(i), 0);
      const float u = s.u1(Decision::Pixel), size = s.u1(Decision::Pixel, 1);
      values.push_back(u < 0.3f ? 0 : u * std::pow(10.0f, -8 * size));
    }
    return values;
  }
  static constexpr int kCounts[] = {1, 5, 16, 17, 100, 512, 513, 5000};  // short and long sums
};

TEST_P(Attenuation, RunningSumsNeverDescendAndAreFlatWhereNothingIsAdded) {
  for (const int n : kCounts) {
    const std::vector<float> values = rough_values(n);
    Arena arena;
    const ArenaScope scope(arena);
    float* const p = arena.alloc_span<float>(values.size()).data();
    std::copy(values.begin(), values.end(), p);
    float* const cdf = alloc_edges(n, arena);
    running_sum(p, n, cdf);
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      ASSERT_GE(cdf[i + 1], cdf[i]) << i << " of " << n;
      if (p[i] == 0) ASSERT_EQ(cdf[i + 1], cdf[i]) << i << " of " << n;
      sum += double(p[i]);
      ASSERT_NEAR(cdf[i + 1], sum, 2e-6 * sum) << i << " of " << n;
    }
  }
}

TEST_P(Attenuation, LightFallsAndIsTheSameWhereNothingAbsorbs) {
  for (const int n : kCounts)
    for (const float scale : {1e-6f, 0.5f, 20.0f})
      for (const bool equal : {true, false}) {
        const std::vector<float> values = rough_values(n);
        Arena arena;
        const ArenaScope scope(arena);
        float* const density = arena.alloc_span<float>(values.size()).data();
        std::copy(values.begin(), values.end(), density);
        float *t = alloc_edges(n, arena), *tau = alloc_edges(n, arena), *transmittance = alloc_edges(n, arena),
              *cdf = alloc_edges(n, arena);
        for (int i = 0; i <= n; ++i) t[i] = 1 + 0.1f * static_cast<float>(i) - (i == n ? 0.03f : 0);
        attenuate({t, n, equal ? 0.1f : 0}, {density, scale}, 0.25f, tau, transmittance, cdf);
        double sum = 0;
        for (int i = 0; i < n; ++i) {
          const double delta = double(t[i + 1]) - double(t[i]);
          ASSERT_GE(tau[i + 1], tau[i]) << i << " of " << n;
          ASSERT_LE(transmittance[i + 1], transmittance[i]) << i << " of " << n;
          ASSERT_GE(cdf[i + 1], cdf[i]) << i << " of " << n;
          if (density[i] == 0) ASSERT_EQ(cdf[i + 1], cdf[i]) << i << " of " << n;
          sum += double(scale) * double(density[i]) * delta;
          // The edges of thousands of segments are rounded.
          ASSERT_NEAR(tau[i + 1], sum, 1e-5 * sum) << i << " of " << n;
          const double depth = double(tau[i + 1]), opacity = -std::expm1(-depth);
          ASSERT_NEAR(transmittance[i + 1], depth < 87 ? std::exp(-depth) : 0, 3e-7 * std::exp(-depth));
          // The remainder of the exponential's series is 1.2e-7 where the opacity is 0.29.
          ASSERT_NEAR(cdf[i + 1], 0.25 * opacity, 6e-7 * 0.25 * opacity);
        }
      }
}

TEST_P(Attenuation, ExponentialsAreOfAsManyValuesAsThereAre) {
  for (const int n : {0, 1, 3, 16, 37}) {
    std::vector<float> values;
    for (int i = 0; i <= n; ++i) values.push_back(i == 5 ? 100.0f : 0.37f * static_cast<float>(i * i));
    const std::vector<float> before = values;
    exp_minus(values.data(), n);
    for (int i = 0; i < n; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double exact = before[at] < 87 ? std::exp(-double(before[at])) : 0;
      EXPECT_NEAR(values[at], exact, 3e-7 * exact) << before[at];
    }
    EXPECT_EQ(values.back(), before.back());
  }
}

INSTANTIATE_TEST_SUITE_P(Levels, Attenuation, testing::ValuesIn(simd_levels()), simd_level_name);

}  // namespace
}  // namespace brume
