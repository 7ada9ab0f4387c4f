// Vectors, frames, affine maps and spectra.
#include <gtest/gtest.h>

#include "renderer/core/ray.h"
#include "renderer/core/spectrum.h"
#include "renderer/core/transform.h"
#include "renderer/sampling/sampler.h"
#include "renderer/sampling/warps.h"

namespace brume {
namespace {

Vec3 random_direction(std::uint32_t i) {
  return uniform_sphere(Sampler(SamplerKind::Independent, 5, 0, i).u2(Decision::Pixel));
}

TEST(Frame, IsOrthonormalAndRightHandedForEveryDirection) {
  std::vector<Vec3> directions{
      {0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}, normalize(Vec3(1e-4f, 0, -1)), normalize(Vec3(0, 1e-20f, -1))};
  for (std::uint32_t i = 0; i < 1000; ++i) directions.push_back(random_direction(i));
  for (const Vec3 n : directions) {
    const Frame f(n);
    // Duff et al. report errors of a few 1e-7 in float.
    EXPECT_NEAR(length(f.s), 1, 1e-6f);
    EXPECT_NEAR(length(f.t), 1, 1e-6f);
    EXPECT_NEAR(dot(f.s, f.t), 0, 1e-6f);
    EXPECT_NEAR(dot(f.s, n), 0, 1e-6f);
    EXPECT_NEAR(dot(f.t, n), 0, 1e-6f);
    EXPECT_NEAR(length(cross(f.s, f.t) - n), 0, 2e-6f);
    EXPECT_EQ(f.to_world({0, 0, 1}), n);
  }
}

TEST(Affine, RotationsTurnAboutXThenYThenZ) {
  EXPECT_NEAR(length(rotation_deg({90, 0, 0}).point({0, 1, 0}) - Vec3d(0, 0, 1)), 0, 1e-15);
  EXPECT_NEAR(length(rotation_deg({0, 90, 0}).point({0, 0, 1}) - Vec3d(1, 0, 0)), 0, 1e-15);
  EXPECT_NEAR(length(rotation_deg({0, 0, 90}).point({1, 0, 0}) - Vec3d(0, 1, 0)), 0, 1e-15);
  EXPECT_NEAR(length(rotation_deg({90, 90, 0}).point({0, 1, 0}) - Vec3d(1, 0, 0)), 0, 1e-15);
  const Affined r = rotation_deg({33, -71, 140});
  EXPECT_NEAR(r.determinant(), 1, 1e-14);
  EXPECT_NEAR(length(r.axis(0)), 1, 1e-14);
}

TEST(Affine, InverseUndoesAndProductsApplyTheInnerMapFirst) {
  const Affined outer = translation({1, -2, 3}) * rotation_deg({20, 40, 60}), inner = scaling({2, -0.5, 3});
  const Vec3d p{0.3, 0.7, -1.1};
  EXPECT_NEAR(length((outer * inner).point(p) - outer.point(inner.point(p))), 0, 1e-14);
  EXPECT_NEAR(length(inverse(outer * inner)->point((outer * inner).point(p)) - p), 0, 1e-14);
  EXPECT_FALSE(inverse(scaling({1, 0, 1})));
  EXPECT_FALSE(inverse(scaling({1, std::numeric_limits<double>::infinity(), 1})));
}

TEST(Affine, ImageOfABoxHoldsEveryImageOfItsPoints) {
  const Affined m = translation({5, 0, -1}) * rotation_deg({10, 50, -80}) * scaling({1, 2, -3});
  const Bounds3 image = transform_bounds(m, {{-1, -1, -1}, {1, 2, 3}});
  Bounds3 corners;
  for (int i = 0; i < 8; ++i) corners.add(m.point(Bounds3{{-1, -1, -1}, {1, 2, 3}}.corner(i)));
  EXPECT_EQ(image.low, corners.low);
  EXPECT_EQ(image.high, corners.high);
  EXPECT_TRUE(transform_bounds(m, {}).empty());
}

TEST(Interval, IsEmptyUnlessItHasALength) {
  EXPECT_TRUE((Interval{1, 1}).empty());
  EXPECT_TRUE((Interval{2, 1}).empty());
  EXPECT_TRUE((Interval{std::numeric_limits<float>::quiet_NaN(), 1}).empty());
  EXPECT_FALSE((Interval{1, 2}).empty());
  EXPECT_TRUE(intersect({0, 1}, {2, 3}).empty());
  EXPECT_EQ(intersect({0, 5}, {2, 9}).begin, 2);
  EXPECT_EQ(intersect({0, 5}, {2, 9}).end, 5);
}

TEST(ChannelWeights, AreProportionalToTheThroughputAndAddToOne) {
  const Spectrum<3> w = channel_weights<3>({1, 2, 5});
  EXPECT_FLOAT_EQ(w[0], 0.125f);
  EXPECT_FLOAT_EQ(w[1], 0.25f);
  EXPECT_FLOAT_EQ(w[2], 0.625f);
  EXPECT_EQ(channel_weights<3>({0, 0, 7})[0], 0);
  for (int c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(channel_weights<3>({0, 0, 0})[c], 1.0f / 3);
  EXPECT_EQ(channel_weights<1>({0.2f, 3, 4})[0], 1);
}

TEST(Ray, BeginsAtItsOriginAndHasNoEndUnlessGivenOne) {
  const Ray ray{{1, 2, 3}, {0, 0, 1}};
  EXPECT_EQ(ray.span.begin, 0);
  EXPECT_EQ(ray.span.end, std::numeric_limits<float>::infinity());
  EXPECT_EQ(ray.at(4), Vec3(1, 2, 7));
}

}  // namespace
}  // namespace brume
