#include <gtest/gtest.h>

#include <vector>

#include "renderer/film/image_io.h"
#include "renderer/lights/constant_environment.h"
#include "renderer/lights/directional_light.h"
#include "renderer/lights/point_light.h"
#include "renderer/lights/quad_light.h"
#include "renderer/lights/registry.h"
#include "renderer/sampling/sampler.h"
#include "tests/support/meshes.h"
#include "tests/support/statistics.h"

namespace brume {
namespace {

/// A light as a scene file makes it; a picture is of one colour, a mesh a cube.
Result<std::unique_ptr<Light>> make(const Node& node, Vec3d scene_origin = {}) {
  Node complete = node;
  if (node.table().find("file")) {
    std::string path = testing::TempDir() + "light_test.exr";
    if (node.kind() == "mesh")
      path = write_obj("light_test.obj", cube_mesh());
    else
      EXPECT_TRUE(write_exr(path, Image(4, 2, Color(1))).ok());
    EXPECT_TRUE(complete.set("file", path).ok());
  }
  FileCache<EnvironmentMap> pictures;
  FileCache<Mesh> meshes;
  auto made = make_light(complete, {scene_origin, pictures, meshes});
  if (!made) return made.error();
  return std::move(made->light);
}

Vec2 random_pair(std::uint32_t i) { return Sampler(SamplerKind::Independent, 4, 1, i).u2(Decision::LightPoint); }
constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(PointLight, IrradianceFallsWithTheSquareOfTheDistance) {
  const PointLight light({1, 2, 3}, {8, 4, 2});
  const IncidentLight in = light.incident(light.sample_point({0.3f, 0.4f}), {1, 2, 1});
  EXPECT_EQ(in.distance, 2);
  EXPECT_EQ(in.wi, Vec3(0, 0, 1));
  EXPECT_EQ(in.irradiance, Color(2, 1, 0.5f));
  EXPECT_EQ(light.sample_point({0, 0}).kind, LightPoint::Kind::Finite);
}

TEST(DirectionalLight, ComesFromWhereItDoesNotTravelTo) {
  const DirectionalLight light({0, 0, -1}, {3, 2, 1});
  const LightPoint point = light.sample_point({0, 0});
  EXPECT_EQ(point.kind, LightPoint::Kind::Distant);
  EXPECT_EQ(point.direction, Vec3(0, 0, 1));
  const IncidentLight in = light.incident(point, {5, 5, 5});
  EXPECT_EQ(in.wi, Vec3(0, 0, 1));
  EXPECT_EQ(in.distance, kInfinity);
  EXPECT_EQ(in.irradiance, Color(3, 2, 1));
}

TEST(ConstantEnvironment, IsSeenOnlyByRaysThatEndNowhere) {
  const ConstantEnvironment light({1, 2, 3});
  EXPECT_EQ(light.sample_point({0, 0}).kind, LightPoint::Kind::Environment);
  EXPECT_EQ(light.environment_radiance(), Color(1, 2, 3));
  ASSERT_TRUE(light.hit({{0, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(light.hit({{0, 0, 0}, {0, 1, 0}})->radiance, Color(1, 2, 3));
  EXPECT_EQ(light.hit({{0, 0, 0}, {0, 1, 0}})->t, kInfinity);
  EXPECT_FALSE(light.hit({{0, 0, 0}, {0, 1, 0}, {0, 100}}));
}

// A 4 x 2 quad in a tilted plane.
const Vec3 kCorner{1, -1, 2}, kEdgeU = Vec3(4, 0, 0), kEdgeV = Vec3(0, 1.2f, 1.6f);

TEST(QuadLight, PointsAreUniformOverTheArea) {
  const QuadLight light(kCorner, kEdgeU, kEdgeV, Color(1), false);
  constexpr int kN = 50000, kBins = 12;
  std::vector<double> observed(kBins * kBins), expected(observed.size(), double(kN) / (kBins * kBins));
  for (std::uint32_t i = 0; i < kN; ++i) {
    const Vec3 p = light.sample_point(random_pair(i)).position - kCorner;
    const float u = dot(p, kEdgeU) / length_squared(kEdgeU), v = dot(p, kEdgeV) / length_squared(kEdgeV);
    ASSERT_NEAR(dot(p, cross(kEdgeU, kEdgeV)), 0, 2e-5f) << "not in the plane";
    ASSERT_TRUE(u >= -1e-6f && u <= 1 && v >= -1e-6f && v <= 1);
    ++observed[static_cast<std::size_t>(std::clamp(u, 0.0f, 0.9999f) * kBins) * kBins +
               static_cast<std::size_t>(std::clamp(v, 0.0f, 0.9999f) * kBins)];
  }
  EXPECT_GT(chi_square_p_value(observed, expected), kChiSquareSignificance);
}

/// Solid angle of a rectangle of half sides a, b seen from height h over its centre: 4 asin(ab /
/// sqrt((a^2+h^2)(b^2+h^2))).
double solid_angle(double a, double b, double h) {
  return 4 * std::asin(a * b / std::sqrt((a * a + h * h) * (b * b + h * h)));
}

TEST(QuadLight, MeanIrradianceIsRadianceTimesSolidAngle) {
  // Incident irradiance is on a plane that faces the light, so its mean is Le times the plain solid angle.
  const Vec3 n = normalize(cross(kEdgeU, kEdgeV)), center = kCorner + kEdgeU * 0.5f + kEdgeV * 0.5f;
  const double z = sidak_z(1e-3, 4);
  for (const float h : {0.5f, 3.0f}) {
    for (const bool two_sided : {false, true}) {
      const QuadLight light(kCorner, kEdgeU, kEdgeV, {2, 1, 0.5f}, two_sided);
      RunningMean front, back;
      for (std::uint32_t i = 0; i < 100000; ++i) {
        const LightPoint point = light.sample_point(random_pair(i));
        const IncidentLight in = light.incident(point, center + n * h);
        ASSERT_NEAR(length(in.wi), 1, 4e-7f);
        ASSERT_NEAR(in.distance, length(point.position - (center + n * h)), 1e-5f);
        front.add(double(in.irradiance.r));
        back.add(double(light.incident(point, center - n * h).irradiance.r));
      }
      const double expected = 2 * solid_angle(2, 1, double(h));
      EXPECT_NEAR(front.mean(), expected, z * front.standard_error());
      if (two_sided) {
        EXPECT_NEAR(back.mean(), expected, z * back.standard_error());
      } else {
        EXPECT_EQ(back.mean(), 0) << "light behind a one-sided quad";
      }
    }
  }
}

TEST(QuadLight, LitPartIsExactlyWhereItsPointsGiveLight) {
  const QuadLight one(kCorner, kEdgeU, kEdgeV, Color(1), false), two(kCorner, kEdgeU, kEdgeV, Color(1), true);
  const LightPoint point = one.sample_point({0.7f, 0.2f});
  int crossings = 0;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const Vec2 a = random_pair(2 * i), b = random_pair(2 * i + 1);
    const Vec3 direction = normalize(Vec3(a.x - 0.5f, a.y - 0.5f, b.x - 0.5f));
    const Ray ray{{10 * b.y - 5, 10 * a.x - 5, 10 * a.y - 5}, direction, {0, 8}};
    const Interval lit = one.lit_part(point, ray);
    if (!lit.empty() && (lit.begin > 0 || lit.end < 8)) ++crossings;
    for (int k = 0; k < 50; ++k) {
      const float t = 8 * (static_cast<float>(k) + 0.5f) / 50;
      const float height = dot(ray.at(t) - kCorner, normalize(cross(kEdgeU, kEdgeV)));
      if (std::abs(height) < 1e-4f) continue;  // rounding decides
      const bool inside = !lit.empty() && t >= lit.begin && t <= lit.end;
      ASSERT_EQ(inside, one.incident(point, ray.at(t)).irradiance.r > 0) << "ray " << i << ", t = " << t;
    }
    const Interval all = two.lit_part(point, ray);
    ASSERT_TRUE(all.begin == 0 && all.end == 8);
  }
  EXPECT_GT(crossings, 100) << "the rays hardly cross the plane";
}

TEST(QuadLight, ARayAlongThePlaneIsLitOnOneSideOnly) {
  const QuadLight light({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, Color(1), false);  // shines along +z
  const LightPoint point = light.sample_point({0.5f, 0.5f});
  EXPECT_FALSE(light.lit_part(point, {{-3, 0, 0.5f}, {1, 0, 0}, {0, 5}}).empty());
  EXPECT_TRUE(light.lit_part(point, {{-3, 0, -0.5f}, {1, 0, 0}, {0, 5}}).empty());
  EXPECT_TRUE(light.lit_part(point, {{-3, 0, 0}, {1, 0, 0}, {0, 5}}).empty());
}

TEST(QuadLight, RaysHitItInsideItsEdgesFromItsLitSide) {
  const QuadLight one(kCorner, kEdgeU, kEdgeV, {5, 6, 7}, false), two(kCorner, kEdgeU, kEdgeV, {5, 6, 7}, true);
  const Vec3 n = normalize(cross(kEdgeU, kEdgeV));
  for (const Vec2 uv : {Vec2{0.01f, 0.01f}, Vec2{0.5f, 0.5f}, Vec2{0.99f, 0.02f}}) {
    const Vec3 target = kCorner + kEdgeU * uv.x + kEdgeV * uv.y, slanted = normalize(n + normalize(kEdgeU) * 0.4f);
    const Ray towards{target + slanted * 3.0f, -slanted};
    ASSERT_TRUE(one.hit(towards));
    EXPECT_NEAR(one.hit(towards)->t, 3, 1e-5f);
    EXPECT_EQ(one.hit(towards)->radiance, Color(5, 6, 7));
    EXPECT_FALSE(one.hit({target - slanted * 3.0f, slanted})) << "from behind";
    EXPECT_TRUE(two.hit({target - slanted * 3.0f, slanted}));
    EXPECT_FALSE(one.hit({target + slanted * 3.0f, slanted})) << "away from it";
    EXPECT_FALSE(one.hit({target + slanted * 3.0f, -slanted, {0, 2.9f}})) << "beyond the span";
  }
  for (const Vec2 uv : {Vec2{-0.01f, 0.5f}, Vec2{1.01f, 0.5f}, Vec2{0.5f, -0.01f}, Vec2{0.5f, 1.01f}})
    EXPECT_FALSE(one.hit({kCorner + kEdgeU * uv.x + kEdgeV * uv.y + n, -n})) << uv.x << ' ' << uv.y;
}

/// Every light that a scene file can name, also those to come.
TEST(LightRegistry, EveryKindMadeFromItsDefaultsGivesFiniteLight) {
  for (const LightType& type : light_types()) {
    const Node node(*type.table);
    const auto light = make(node);
    ASSERT_TRUE(light.ok()) << type.table->key;
    EXPECT_EQ((*light)->visible_to_camera, node.flag("visible_to_camera"));
    float brightest = max_channel((*light)->environment_radiance());
    for (std::uint32_t i = 0; i < 200; ++i) {
      const LightPoint point = (*light)->sample_point(random_pair(i));
      ASSERT_EQ(point.kind, (*light)->kind()) << type.table->key;
      if (point.kind == LightPoint::Kind::Environment) continue;
      for (const Vec3 x : {Vec3(0, 0, 0), Vec3(0, 0, 10), Vec3(3, -4, 1)}) {
        const IncidentLight in = (*light)->incident(point, x);
        ASSERT_TRUE(is_finite(in.irradiance) && std::abs(length(in.wi) - 1) < 1e-6f) << type.table->key;
        brightest = std::max(brightest, max_channel(in.irradiance));
      }
      const Ray ray{{0, 0, -2}, {0, 0, 1}, {0, 5}};
      const Interval lit = (*light)->lit_part(point, ray);
      EXPECT_TRUE(lit.empty() || (lit.begin >= 0 && lit.end <= 5)) << type.table->key << " lights more than the ray";
    }
    EXPECT_GT(brightest, 0) << type.table->key << " is dark by default";
  }
}

TEST(LightRegistry, LightsMoveWithTheOriginOfTheScene) {
  for (const LightType& type : light_types()) {
    const Vec3d origin(1e6, -2e6, 3e6);
    Node here(*type.table), far(*type.table);
    for (const Param& p : type.table->params) {
      if (p.type != ParamType::Point) continue;
      const Vec3d at = here.vec3(p.key) + origin;
      ASSERT_TRUE(far.set(p.key, Numbers{at.x, at.y, at.z}).ok());
    }
    if (type.table->find_slot("transform"))
      ASSERT_TRUE(far.child("transform").set("translate", Numbers{origin.x, origin.y, origin.z}).ok());
    const auto a = make(here), b = make(far, origin);
    ASSERT_TRUE(a.ok() && b.ok());
    const LightPoint pa = (*a)->sample_point({0.3f, 0.6f}), pb = (*b)->sample_point({0.3f, 0.6f});
    EXPECT_EQ(pa.position, pb.position) << type.table->key;
    EXPECT_EQ(pa.direction, pb.direction) << type.table->key;
  }
}

TEST(LightRegistry, ImpossibleLightsAreRefusedByTheNameOfTheKey) {
  Node quad(*light_family().find("quad"));
  ASSERT_TRUE(quad.set("edge_v", Numbers{0, 2, 0}).ok());  // along edge_u
  const auto made = make(quad);
  ASSERT_FALSE(made.ok());
  EXPECT_EQ(made.error().source.key, "edge_v");
  Node sun(*light_family().find("directional"));
  ASSERT_TRUE(sun.set("direction", Numbers{0, 0, 0}).ok());
  ASSERT_FALSE(make(sun).ok());
  EXPECT_EQ(make(sun).error().source.key, "direction");
}

}  // namespace
}  // namespace brume
