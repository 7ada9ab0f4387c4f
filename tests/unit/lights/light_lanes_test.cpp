#include "renderer/lights/light_lanes.h"

#include <gtest/gtest.h>

#include "renderer/lights/directional_light.h"
#include "renderer/lights/disc_light.h"
#include "renderer/lights/point_light.h"
#include "renderer/lights/quad_light.h"
#include "renderer/lights/sphere_light.h"
#include "renderer/lights/spot_light.h"
#include "renderer/sampling/sampler.h"
#include "tests/support/simd_levels.h"

namespace brume {
namespace {

class LightLanesAt : public AtSimdLevel {};

Vec2 random_pair(std::uint32_t i, int index) {
  return Sampler(SamplerKind::Independent, 21, 5, i).u2(Decision::LightPoint, 0, index);
}

Vec3 random_place(std::uint32_t i, int index) {
  const Vec2 a = random_pair(i, index), b = random_pair(i, index + 1);
  return {4 * a.x - 2, 4 * a.y - 2, 4 * b.x - 2};
}

std::vector<std::unique_ptr<Light>> some_lights() {
  const Color color{3, 2, 1};
  const Vec3 axis = normalize(Vec3(1, 2, -3));
  std::vector<std::unique_ptr<Light>> lights;
  lights.push_back(std::make_unique<PointLight>(Vec3(0.3f, -0.2f, 0.5f), color));
  lights.push_back(std::make_unique<SpotLight>(Vec3(0.1f, 0, 1), axis, 1.0f, 0.6f, color));
  lights.push_back(std::make_unique<SpotLight>(Vec3(0.1f, 0, 1), axis, 0.5f, 0.0f, color));
  lights.push_back(std::make_unique<QuadLight>(Vec3(-1, -1, 0.2f), Vec3(2, 0, 0), Vec3(0, 1, 0.5f), color, false));
  lights.push_back(std::make_unique<QuadLight>(Vec3(-1, -1, 0.2f), Vec3(2, 0, 0), Vec3(0, 1, 0.5f), color, true));
  lights.push_back(std::make_unique<DiscLight>(Vec3(0.5f, 0, -1), axis, 0.5f, color, false));
  lights.push_back(std::make_unique<SphereLight>(Vec3(0, 0.5f, 0), 0.4f, color));
  lights.push_back(std::make_unique<DirectionalLight>(axis, color));
  lights.push_back(std::make_unique<DirectionalLight>(axis, color, 0.5f));
  return lights;
}

TEST_P(LightLanesAt, ReceiveWhatEachLightSends) {
  const auto lights = some_lights();
  const int n = static_cast<int>(lights.size());
  ASSERT_LE(n, kWidestVector);
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const Ray ray{random_place(i, 0), normalize(random_place(i, 2) + Vec3(0, 0, 0.01f))};
    LightLanes lanes;
    LaneArray<float> t;
    std::vector<LightPoint> points;
    for (int k = 0; k < n; ++k) {
      points.push_back(lights[static_cast<std::size_t>(k)]->sample_point(random_pair(i, 10 + k)));
      lanes.set(k, points.back());
      t[k] = 3 * random_pair(i, 40 + k).x;
    }
    lanes.look(ray, t, n);
    for (int k = 0; k < n; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const IncidentLight in = lights[at]->incident(points[at], ray.at(t[k]));
      ASSERT_EQ(lanes.x(k), ray.at(t[k])) << k;
      ASSERT_LT(length(lanes.wi(k) - in.wi), 5e-7f) << k;
      if (std::isfinite(in.distance))
        ASSERT_NEAR(lanes.distance(k) / in.distance, 1, 5e-7f) << k;
      else
        ASSERT_EQ(lanes.distance(k), in.distance) << k;
      ASSERT_NEAR(lanes.cosine()[k], dot(ray.direction, in.wi), 5e-7f) << k;
      // What a rounding of the cosine is to the falloff, which is nowhere steeper than this unless its border is sharp.
      const float r2 = std::isfinite(in.distance) ? in.distance * in.distance : 1;
      const float tolerance =
          1e-6f * (in.irradiance.r + points[at].sent.r / r2 * std::min(points[at].falloff.slope, 30.0f));
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(lanes.sent(c)[k] * lanes.seen()[k], in.irradiance[c], tolerance) << "light " << k << ", ray " << i;
    }
  }
}

TEST_P(LightLanesAt, NothingIsReceivedAtTheLightItself) {
  const PointLight light({1, 2, 3}, Color(5));
  LightLanes lanes;
  LaneArray<float> t;
  lanes.set(0, light.sample_point({}));
  t[0] = 0;
  lanes.look({{1, 2, 3}, {0, 0, 1}}, t, 1);
  EXPECT_EQ(lanes.seen()[0], 0);
  EXPECT_TRUE(std::isfinite(lanes.cosine()[0])) << "a phase function is asked for it";
}

TEST_P(LightLanesAt, OtherThingsCanBeSeenInstead) {
  const PointLight light({1, 2, 3}, Color(5));
  LightLanes lanes;
  LaneArray<float> t;
  for (int k = 0; k < 2; ++k) lanes.set(k, light.sample_point({})), t[k] = 1;
  lanes.look({{0, 0, 0}, {0, 0, 1}}, t, 2);
  const float left_alone = lanes.seen()[0];
  lanes.replace(1, {0, 1, 0}, 7, {3, 2, 1});
  EXPECT_EQ(lanes.wi(1), Vec3(0, 1, 0));
  EXPECT_EQ(lanes.distance(1), 7);
  for (int c = 0; c < 3; ++c) EXPECT_EQ(lanes.sent(c)[1] * lanes.seen()[1], Color(3, 2, 1)[c]);
  EXPECT_EQ(lanes.seen()[0], left_alone);
}

INSTANTIATE_TEST_SUITE_P(Levels, LightLanesAt, testing::ValuesIn(simd_levels()), simd_level_name);

}  // namespace
}  // namespace brume
