#include "renderer/march/distribute.h"

#include <gtest/gtest.h>

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
    EXPECT_NEAR(scattered_in(*r, 0, 0) / (0.8 * double(sigma) * length), 1, kFloatError);
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

/// A rough medium in three channels, one of which does not interact at all.
Medium rough_box() {
  const auto rough = [](float z) { return std::max(0.0f, std::sin(9 * z) + 0.4f); };
  return profile_box(rough, kLow, kHigh, {0.5f, 0, 8}, {1, 0, 10}, {1, 2, 3});
}

void expect_parts_match_their_definition(std::vector<Medium> media) {
  const Color throughput{0.2f, 0.5f, 0.3f};
  RecordedRay<3> r(std::move(media), ray_along_z(-1), 0.037f, 0.3f, throughput);
  Arena arena;
  const ArenaScope scope(arena);
  const float* const p = scattered_by_segment(*r, arena);
  double cdf = 0, emitted[3] = {};
  std::array<double, 3> tau = {};
  for (int i = 0; i < r->n; ++i) {
    const double delta = double(r->t[i + 1]) - double(r->t[i]);
    double scattered = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_NEAR(r->tau[c][i], tau[c], 1e-5);
      const double sigma = double(r->sigma_t[c][i]),
                   length = std::exp(-tau[c]) * (sigma > 0 ? -std::expm1(-sigma * delta) / sigma : delta),
                   part = double(throughput[static_cast<int>(c)]) * double(r->sigma_s[c][i]) * length;
      ASSERT_NEAR(scattered_in(*r, i, static_cast<int>(c)), part, 2e-5 * part);  // the error of tau is in the exponent
      scattered += part;
      emitted[c] += double(r->emission[c][i]) * length;
      tau[c] += sigma * delta;
    }
    ASSERT_NEAR(p[i], scattered, 2e-5 * scattered);
    cdf += scattered;
    ASSERT_NEAR(r->cdf[i + 1], cdf, 1e-5);
    ASSERT_GE(r->cdf[i + 1], r->cdf[i]);
  }
  const Color sum = emitted_radiance(*r);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / emitted[c], 1, 2e-5);
  EXPECT_EQ(r->tau[1][r->n], 0);
  EXPECT_EQ(transmittance(*r)[1], 1);
  EXPECT_EQ(r->scattered(), r->cdf[r->n]);
}

TEST(Distribute, EveryPartMatchesItsDefinitionInDouble) {
  expect_parts_match_their_definition(
      {rough_box(), homogeneous_box({-1, -1, 0.5}, {1, 1, 3}, {0.2f, 0, 0}, {0.3f, 0, 0.1f})});
}

// What is scattered is then a share of what the transmittance falls by, without another sum.
TEST(Distribute, EveryPartOfASingleMediumMatchesItsDefinitionInDouble) {
  expect_parts_match_their_definition({rough_box()});
}

// Product sampling may want what the differences of a float running sum cannot tell: far behind a dense front, and
// where segments are so thin that the transmittance stays the same float.
TEST(Distribute, WhatASegmentScattersIsPreciseBehindDenseMediaAndInThinOnes) {
  for (const float front : {0.0f, 1.0f, 60.0f}) {
    const auto profile = [front](float z) { return z < 1 ? front : 1e-9f; };
    RecordedRay<1> r({profile_box(profile, kLow, kHigh, Color(0.5f), Color(1))}, ray_along_z(-1), 0.01f);
    Arena arena;
    const ArenaScope scope(arena);
    const float* const p = scattered_by_segment(*r, arena);
    for (int i = 101; i < r->n; ++i) {
      const double delta = double(r->t[i + 1]) - double(r->t[i]), part = 0.5e-9 * delta * std::exp(-double(front));
      ASSERT_NEAR(p[i], part, 1e-5 * part) << front;
      ASSERT_NEAR(scattered_in(*r, i, 0), part, 1e-5 * part) << front;
    }
  }
}

TEST(Distribute, VeryThickMediaUnderflowToDarknessNotToNaN) {
  for (const float sigma : {100.0f, 1e4f, 1e9f}) {
    RecordedRay<1> r(
        {profile_box([](float) { return 1.0f; }, kLow, kHigh, Color(0.5f * sigma), Color(sigma), Color(1))},
        ray_along_z(-1), 0.01f);
    EXPECT_NEAR(r->scattered(), 0.5, 1e-5);
    EXPECT_NEAR(emitted_radiance(*r).r * sigma, 1, 1e-5);
    EXPECT_EQ(transmittance(*r)[0], std::exp(-2 * sigma));
    Arena arena;
    const ArenaScope scope(arena);
    const float* const p = scattered_by_segment(*r, arena);
    for (int i = 0; i < r->n; ++i) ASSERT_TRUE(p[i] >= 0 && p[i] <= 0.5f + 1e-6f);
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

}  // namespace
}  // namespace brume
