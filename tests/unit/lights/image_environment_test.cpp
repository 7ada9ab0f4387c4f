#include "renderer/lights/image_environment.h"

#include <gtest/gtest.h>

#include "tests/support/statistics.h"
#include "tests/unit/lights/environment_pictures.h"

namespace brume {
namespace {

TEST(ImageEnvironment, TurnsCounterClockwiseSeenFromAbove) {
  const auto map = std::make_shared<const EnvironmentMap>(patchy(24, 12));
  for (const float degrees : {0.0f, 90.0f, -30.0f, 200.0f}) {
    const float angle = degrees * kPi / 180;
    const ImageEnvironment light(map, {2, 3, 4}, angle);
    // What the picture has along +x is now at that angle from +x towards +y.
    for (const float z : {0.0f, 0.7f, -0.4f}) {
      const Vec3 turned = normalize(Vec3(std::cos(angle), std::sin(angle), z));
      const Color seen = light.hit({{}, turned})->radiance, there = map->radiance(normalize(Vec3(1, 0, z)));
      // Rounded by 3e-7 of the picture between values of up to 1e4 times this one.
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(seen[k], Color(2, 3, 4)[k] * there[k], 0.05f) << degrees << ", " << z;
    }
  }
}

TEST(ImageEnvironment, HitAgreesWithIncident) {
  const auto map = std::make_shared<const EnvironmentMap>(patchy(24, 12));
  const ImageEnvironment light(map, {2, 3, 4}, 1.1f);
  for (std::uint32_t i = 0; i < 5000; ++i) {
    const LightPoint point = light.sample_point(random_pair(i));
    EXPECT_EQ(point.kind, LightPoint::Kind::Distant);
    const IncidentLight in = light.incident(point, {1, 2, 3});
    const auto hit = light.hit({{4, 5, 6}, point.direction});
    ASSERT_TRUE(hit);
    EXPECT_EQ(in.wi, point.direction);
    EXPECT_EQ(in.distance, kInfinity);
    EXPECT_EQ(hit->t, kInfinity);
    EXPECT_EQ(hit->pdf_w, in.pdf_w);
    ASSERT_GT(in.pdf_w, 0);
    EXPECT_NEAR(in.irradiance.g * in.pdf_w, hit->radiance.g, 2e-6f * hit->radiance.g);
    EXPECT_EQ(hit->point.kind, LightPoint::Kind::Distant);
    EXPECT_EQ(hit->point.direction, point.direction);
  }
  EXPECT_FALSE(light.hit({{}, {1, 0, 0}, {0, 1e6f}})) << "infinitely far away";
  EXPECT_EQ(light.environment_radiance(), Color()) << "not the same all around";
  EXPECT_EQ(light.solid_angle({1, 2, 3}), map->solid_angle());
}

TEST(ImageEnvironment, BothEstimatesOfTheIrradianceAgree) {
  // By sampled points, and by hits of directions that are uniform over (u, v), for a plane that sees half of the sky.
  const double z = sidak_z(1e-3, 2);
  const auto map = std::make_shared<const EnvironmentMap>(patchy(24, 12));
  const Vec3 normal = normalize(Vec3(1, 1, 1));
  for (const float angle : {0.0f, 2.5f}) {
    const ImageEnvironment light(map, Color(1), angle);
    RunningMean sampled, met;
    for (std::uint32_t i = 0; i < 100000; ++i) {
      const IncidentLight in = light.incident(light.sample_point(random_pair(i)), {});
      sampled.add(double(in.irradiance.r * std::max(0.0f, dot(normal, in.wi))));
      const Vec2 p = random_pair(i, 1);
      const Vec3 w = seen_at(double(p.x), double(p.y));
      met.add(per_place(double(light.hit({{}, w})->radiance.r * std::max(0.0f, dot(normal, w))), double(p.y)));
    }
    EXPECT_NEAR(sampled.mean(), met.mean(), z * std::hypot(sampled.standard_error(), met.standard_error()));
    EXPECT_LT(sampled.standard_error(), met.standard_error()) << "in proportion to the light";
  }
}

TEST(ImageEnvironment, ABlackPictureLightsNothing) {
  const ImageEnvironment light(std::make_shared<const EnvironmentMap>(Image(4, 2)), Color(1), 0);
  for (std::uint32_t i = 0; i < 100; ++i)
    EXPECT_TRUE(is_black(light.incident(light.sample_point(random_pair(i)), {}).irradiance));
}

}  // namespace
}  // namespace brume
