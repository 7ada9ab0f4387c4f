#include "renderer/march/shadow_march.h"

#include <gtest/gtest.h>

#include "tests/support/media.h"

namespace brume {
namespace {

double shadow_tau(const std::vector<Medium>& media, const Ray& ray, float step, float offset, int channel = 0) {
  Arena arena;
  MarchCounts counts;
  return double(shadow_optical_depth<3>(media, ray, {step, offset, 0}, arena, counts)[channel]);
}

TEST(ShadowMarch, OpticalDepthOfAHomogeneousMediumIsExactAtEveryStep) {
  const std::vector<Medium> media{homogeneous_box({-1, -1, 0}, {1, 1, 2}, {1, 1, 1}, {1, 2, 4})};
  for (const float step : {1e-3f, 0.3f, 100.0f})
    for (int c = 0; c < 3; ++c)
      EXPECT_FLOAT_EQ(static_cast<float>(shadow_tau(media, ray_along_z(-1), step, 0.3f, c)),
                      static_cast<float>(2 << c));
}

TEST(ShadowMarch, AgreesWithTheRecordOfTheSameRayAndOffset) {
  const std::vector<Medium> media{
      profile_box([](float z) { return 1 + std::sin(5 * z); }, {-1, -1, 0}, {1, 1, 2}, Color(1), {1, 2, 4}),
      profile_box([](float z) { return z * z; }, {-1, -1, 1.3}, {1, 1, 2.7}, Color(1), {3, 2, 1}),
      homogeneous_box({-1, -1, 4}, {1, 1, 5}, Color(1), {1, 2, 1})};
  // A single medium is split into the same segments. Overlapping ones are split apart by record() at each other's
  // borders, so only their means over the offset are equal: see the next test.
  for (const float offset : {0.0f, 0.4f, 0.99f})
    for (std::size_t m = 0; m < media.size(); ++m) {
      RecordedRay<3> r({media[m]}, ray_along_z(-1), 0.07f, offset);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(
            shadow_tau({media[m]}, ray_along_z(-1), 0.07f, offset, c) / r->tau[static_cast<std::size_t>(c)][r->n], 1,
            1e-6)
            << m;
    }
}

TEST(ShadowMarch, MeanOverTheOffsetIsTheOpticalDepthWhateverTheStep) {
  // Every point of the ray is looked up with the same probability, also in the last, shorter segment.
  const auto density = [](float z) { return z < 1.1f ? 3.0f : z; };
  const std::vector<Medium> media{profile_box(density, {-1, -1, 0}, {1, 1, 2}, Color(0), Color(1)),
                                  profile_box(density, {-1, -1, 0.5}, {1, 1, 1.7}, Color(0), Color(1))};
  const double exact = 3 * 1.1 + 0.5 * (4 - 1.21) + 3 * 0.6 + 0.5 * (1.7 * 1.7 - 1.21);
  for (const float step : {0.9f, 0.37f, 0.051f}) {
    double shadow = 0, recorded = 0;
    constexpr int kOffsets = 4000;
    for (int k = 0; k < kOffsets; ++k) {
      const float offset = (static_cast<float>(k) + 0.5f) / kOffsets;
      shadow += shadow_tau(media, ray_along_z(-1), step, offset) / kOffsets;
      RecordedRay<1> r(media, ray_along_z(-1), step, offset);
      recorded += double(r->tau[0][r->n]) / kOffsets;
    }
    // A jump of 3 that moves by one of the offsets' strata.
    EXPECT_NEAR(shadow, exact, 3.0 * double(step) / kOffsets + 1e-5) << "step " << step;
    EXPECT_NEAR(recorded, exact, 3.0 * double(step) / kOffsets + 1e-5) << "step " << step;
  }
}

TEST(ShadowMarch, OnlyTheSpanOfTheRayCounts) {
  const std::vector<Medium> media{homogeneous_box({-1, -1, 0}, {1, 1, 2}, Color(1), Color(1)),
                                  profile_box([](float) { return 1.0f; }, {-1, -1, 3}, {1, 1, 5}, Color(1), Color(1))};
  EXPECT_NEAR(shadow_tau(media, ray_along_z(-1, {0, 1.5f}), 0.1f, 0.5f), 0.5, 1e-6);
  EXPECT_NEAR(shadow_tau(media, ray_along_z(1, {0, 2.5f}), 0.1f, 0.5f), 1.5, 1e-6);
  EXPECT_NEAR(shadow_tau(media, ray_along_z(-1, {0, 0.5f}), 0.1f, 0.5f), 0, 0);
  EXPECT_NEAR(shadow_tau(media, {{0, 0, 9}, {0, 0, -1}, {0, std::numeric_limits<float>::infinity()}}, 0.1f, 0.5f), 4,
              1e-6);
}

TEST(ShadowMarch, LeavesTheArenaAsItWas) {
  Arena arena;
  MarchCounts counts;
  const ArenaScope scope(arena);
  const std::size_t before = arena.used_bytes();
  const std::vector<Medium> media{profile_box([](float) { return 1.0f; }, {-1, -1, 0}, {1, 1, 2}, Color(1), Color(1))};
  EXPECT_NEAR(shadow_transmittance<1>(media, ray_along_z(-1), {0.01f, 0.5f, 0}, arena, counts)[0], std::exp(-2.0),
              1e-6);
  EXPECT_EQ(arena.used_bytes(), before);
  EXPECT_EQ(counts.lookups, 200u);
}

}  // namespace
}  // namespace brume
