#include "renderer/integrators/light_weights.h"

#include <gtest/gtest.h>

#include "renderer/lights/point_light.h"
#include "renderer/sampling/sampler.h"
#include "tests/support/mis_weight.h"
#include "tests/support/simd_levels.h"

namespace brume {
namespace {

class LightWeightsAt : public AtSimdLevel {};

/// Numbers over some orders of magnitude.
float random_size(std::uint32_t i, int index) {
  return std::exp(8 * Sampler(SamplerKind::Independent, 22, 6, i).u1(Decision::LightPoint, 0, index) - 4);
}

/// Lanes of all kinds side by side, one without a density, against the equation of carry().
template <int C> void expect_what_the_equation_says(MisHeuristic heuristic) {
  const Color beta{0.7f, 0.2f, 1.5f};
  const int n = kWidestVector;
  for (std::uint32_t i = 0; i < 500; ++i) {
    LightLanes lights;
    LightWeights<C> w;
    int number = 0;
    const auto next = [&] { return random_size(i, number++); };
    for (int k = 0; k < n; ++k) {
      lights.set(k, {});
      lights.replace(k, {0, 0, 1}, 1, {next(), next(), next()});
      w.factor[k] = next(), w.pdf_ratio[k] = next(), w.phase[k] = next();
      w.equiangular[k] = next(), w.unaimed[k] = k == 5 ? 0 : next();
      w.drawn[k] = (k % 2 ? LightWeights<C>::kAbout : 0) | (k % 4 > 1 ? LightWeights<C>::kCombined : 0);
      if (k == 9 || k == 11) w.equiangular[k] = 0;
      if (k == 7) w.unaimed[k] = 0;
      if (k == 11) w.unaimed[k] = 0;
      for (int c = 0; c < C; ++c) w.scattered[c][k] = next(), w.left[c][k] = 1 / (1 + next());
    }
    carry(w, lights, beta, heuristic, n);
    for (int k = 0; k < n; ++k) {
      const bool about = w.drawn[k] & LightWeights<C>::kAbout, combined = w.drawn[k] & LightWeights<C>::kCombined;
      const float drawn = about ? w.equiangular[k] : w.unaimed[k], directed = w.unaimed[k] * w.pdf_ratio[k];
      const float weight = !combined ? 1
                           : about   ? mis_weight(heuristic, w.equiangular[k], directed)
                                     : mis_weight(heuristic, directed, w.equiangular[k]);
      for (int c = 0; c < 3; ++c) {
        const int channel = C == 1 ? 0 : c;
        const float expected = drawn > 0 ? beta[c] * w.scattered[channel][k] * w.left[channel][k] * w.phase[k] *
                                               lights.sent(c)[k] * w.factor[k] * weight / drawn
                                         : 0;
        ASSERT_NEAR(w.carried[c][k], expected, 2e-6f * expected) << "lane " << k;
      }
    }
  }
}

TEST_P(LightWeightsAt, CarryWhatTheEquationSays) {
  for (const MisHeuristic heuristic : {MisHeuristic::Balance, MisHeuristic::Power}) {
    expect_what_the_equation_says<1>(heuristic);
    expect_what_the_equation_says<3>(heuristic);
  }
}

INSTANTIATE_TEST_SUITE_P(Levels, LightWeightsAt, testing::ValuesIn(simd_levels()), simd_level_name);

}  // namespace
}  // namespace brume
