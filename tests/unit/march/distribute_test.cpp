#include "renderer/march/distribute.h"

#include <gtest/gtest.h>

#include "renderer/core/simd.h"
#include "renderer/march/step_loops.h"
#include "renderer/sampling/sampler.h"
#include "tests/support/media.h"

namespace brume {
namespace {

const Vec3d kLow{-1, -1, 0}, kHigh{1, 1, 2};

/// Relative error of the SIMD exponentials (a few units in the last place each) and of the products round them.
constexpr double kFloatError = 2e-6;

TEST(Distribute, HomogeneousMediumHasItsClosedForm) {
  for (const float sigma : {1e-3f, 0.5f, 3.0f, 30.0f}) {
    RecordedRay<1> r({homogeneous_box(kLow, kHigh, Color(0.8f * sigma), Color(sigma), {1, 2, 3})}, ray_along_z(-1), 1);
    const double tau = 2 * double(sigma), length = -std::expm1(-tau) / double(sigma);
    EXPECT_NEAR(r->tau[0][1] / tau, 1, kFloatError);
    EXPECT_NEAR(r->length[0][0] / length, 1, kFloatError);
    EXPECT_NEAR(transmittance(*r)[0] / std::exp(-tau), 1, kFloatError * (1 + tau));
    EXPECT_NEAR(r->scattered() / (0.8 * -std::expm1(-tau)), 1, kFloatError);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(emitted_radiance(*r)[c] / ((c + 1) * length), 1, kFloatError);
  }
}

// B7 of the catalogue: 1 - exp(-x) in float is off by 19 % at 1e-7 and is 0 at 1e-8.
TEST(Distribute, ThinMediaEmitAndScatterInProportionToTheirLength) {
  for (const float tau : {1e-20f, 1e-10f, 1e-8f, 1e-7f, 1e-5f, 0.99e-4f, 1.01e-4f, 1e-3f}) {
    const float sigma = tau / 2;
    RecordedRay<1> r({homogeneous_box(kLow, kHigh, Color(sigma), Color(sigma), Color(1))}, ray_along_z(-1), 1);
    const double mean = -std::expm1(-double(tau)) / double(tau);  // of the transmittance over the segment
    EXPECT_NEAR(emitted_radiance(*r).g / (2 * mean), 1, 1e-6) << "tau = " << tau;
    EXPECT_NEAR(r->scattered() / (double(tau) * mean), 1, 1e-6) << "tau = " << tau;
  }
}

TEST(Distribute, WithoutExtinctionEmissionIsItsColumn) {
  RecordedRay<1> r({homogeneous_box(kLow, kHigh, Color(0), Color(0), {1, 2, 3})}, ray_along_z(-1), 1);
  EXPECT_EQ(emitted_radiance(*r), Color(2, 4, 6));
  EXPECT_EQ(transmittance(*r)[0], 1);
  EXPECT_EQ(r->scattered(), 0);
}

TEST(Distribute, ManyThinSegmentsAddUpToTheOpticalDepth) {
  // 60000 float additions would lose 1e-3; sums are kept in double.
  RecordedRay<1> r({profile_box([](float) { return 1.0f; }, kLow, kHigh, Color(1), Color(1))}, ray_along_z(-1),
                   2.0f / 60000);
  EXPECT_NEAR(r->tau[0][r->n], 2, 2e-6);
  EXPECT_NEAR(r->scattered(), -std::expm1(-2.0), 2e-6);
}

TEST(Distribute, EveryPartMatchesItsDefinitionInDouble) {
  // A rough medium in three channels, one of which does not interact at all.
  const auto rough = [](float z) { return std::max(0.0f, std::sin(9 * z) + 0.4f); };
  std::vector<Medium> media{profile_box(rough, kLow, kHigh, {0.5f, 0, 8}, {1, 0, 10}, {1, 2, 3}),
                            homogeneous_box({-1, -1, 0.5}, {1, 1, 3}, {0.2f, 0, 0}, {0.3f, 0, 0.1f})};
  const Color throughput{0.2f, 0.5f, 0.3f};
  RecordedRay<3> r(std::move(media), ray_along_z(-1), 0.037f, 0.3f, throughput);
  double cdf = 0, emitted[3] = {};
  std::array<double, 3> tau = {};
  for (int i = 0; i < r->n; ++i) {
    const double delta = double(r->t[i + 1]) - double(r->t[i]);
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_NEAR(r->tau[c][i], tau[c], 1e-5);
      const double sigma = double(r->sigma_t[c][i]),
                   length = std::exp(-tau[c]) * (sigma > 0 ? -std::expm1(-sigma * delta) / sigma : delta);
      ASSERT_NEAR(r->length[c][i] / length, 1, 2e-5);  // the error of tau is in the exponent
      cdf += double(throughput[static_cast<int>(c)]) * double(r->sigma_s[c][i]) * length;
      emitted[c] += double(r->emission[c][i]) * length;
      tau[c] += sigma * delta;
    }
    ASSERT_NEAR(r->cdf[i + 1], cdf, 1e-5);
    ASSERT_GE(r->cdf[i + 1], r->cdf[i]);
  }
  const Color sum = emitted_radiance(*r);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / emitted[c], 1, 2e-5);
  EXPECT_EQ(r->tau[1][r->n], 0);
  EXPECT_EQ(transmittance(*r)[1], 1);
  EXPECT_EQ(r->scattered(), r->cdf[r->n]);
}

TEST(Distribute, VeryThickMediaUnderflowToDarknessNotToNaN) {
  for (const float sigma : {100.0f, 1e4f, 1e9f}) {
    RecordedRay<1> r(
        {profile_box([](float) { return 1.0f; }, kLow, kHigh, Color(0.5f * sigma), Color(sigma), Color(1))},
        ray_along_z(-1), 0.01f);
    EXPECT_NEAR(r->scattered(), 0.5, 1e-5);
    EXPECT_NEAR(emitted_radiance(*r).r * sigma, 1, 1e-5);
    EXPECT_EQ(transmittance(*r)[0], std::exp(-2 * sigma));
    for (int i = 0; i < r->n; ++i) ASSERT_TRUE(r->length[0][i] >= 0 && r->length[0][i] <= 0.011f);
  }
}

TEST(Distribute, EmptyRecordIsClear) {
  const MarchRecord<3> nothing;
  for (int c = 0; c < 3; ++c) EXPECT_EQ(transmittance(nothing)[c], 1);
  EXPECT_EQ(emitted_radiance(nothing), Color(0));
}

// The piecewise-constant march of a stack of slabs is exact when segments end on its edges, wherever it looks.
TEST(Distribute, SlabsAlignedWithSegmentsAreExactForEveryOffset) {
  const std::vector<float> edges{0, 0.25f, 0.5f, 0.75f, 1, 1.25f, 1.5f, 1.75f, 2}, values{1, 0, 2, 0, 0.5f, 4, 0, 1};
  const auto shader = std::make_shared<ProfileShader>(Affine{}, 0.25f, slabs_profile(2, edges, values));
  const Medium medium = medium_of(shader, std::make_shared<BoxShape>(kLow, kHigh), Color(0.5f), Color(1.5f), Color(3));
  double tau = 0, emitted = 0;
  for (const float v : values) {
    const double x = 1.5 * double(v) * 0.25;
    emitted += 3 / 1.5 * std::exp(-tau) * -std::expm1(-x);
    tau += x;
  }
  for (const float offset : {0.0f, 1e-3f, 0.5f, 0.9999f}) {
    RecordedRay<1> r({medium}, ray_along_z(-3), 0.25f, offset);
    ASSERT_EQ(r->n, 8);
    EXPECT_NEAR(r->tau[0][8] / tau, 1, kFloatError) << "offset " << offset;
    EXPECT_NEAR(emitted_radiance(*r).r / emitted, 1, kFloatError) << "offset " << offset;
    EXPECT_NEAR(r->scattered() / (-std::expm1(-tau) / 3), 1, kFloatError) << "offset " << offset;
  }
}

TEST(ExpMinus, IsTheExponentialOfAsManyValuesAsThereAreAtEveryLevel) {
  for (const std::string& level : simd_levels()) {
    ASSERT_TRUE(force_simd_level(level).ok());
    for (const int n : {0, 1, 3, 16, 37}) {
      std::vector<float> values;
      for (int i = 0; i <= n; ++i) values.push_back(i == 5 ? 100.0f : 0.37f * static_cast<float>(i * i));
      const std::vector<float> before = values;
      exp_minus(values.data(), n);
      for (int i = 0; i < n; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const double exact = before[at] < 87 ? std::exp(-double(before[at])) : 0;
        EXPECT_NEAR(values[at], exact, 3e-7 * exact) << level << ' ' << before[at];
      }
      EXPECT_EQ(values.back(), before.back()) << level;
    }
  }
  ASSERT_TRUE(force_simd_level("auto").ok());
}

}  // namespace
}  // namespace brume
