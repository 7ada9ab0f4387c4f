#include "renderer/lights/spot_light.h"

#include <gtest/gtest.h>

#include "renderer/sampling/sampler.h"
#include "renderer/sampling/warps.h"
#include "tests/support/statistics.h"

namespace brume {
namespace {

constexpr double kPiD = 3.14159265358979323846;
const Vec3 kTip{1, 2, 3}, kAxis = normalize(Vec3(1, -2, -2));

Vec2 random_pair(std::uint32_t i, int index = 0) {
  return Sampler(SamplerKind::Independent, 15, 9, i).u2(Decision::LightPoint, 0, index);
}

struct Cone {
  float angle, blend;
  double cos_outer() const { return std::max(0.0, std::cos(double(angle))); }
  double cos_inner() const { return cos_outer() + double(blend) * (1 - cos_outer()); }
  SpotLight light() const { return {kTip, kAxis, angle, blend, {8, 4, 2}}; }
};
constexpr Cone kCones[] = {{0.5f, 0.3f}, {0.5f, 0},       {0.5f, 1},   {0.02f, 0.5f},
                           {1.2f, 0.1f}, {kPi / 2, 0.3f}, {kPi / 2, 0}};

/// A unit direction at `angle` from the axis.
Vec3 off_axis(double angle, double azimuth = 0.7) {
  const Vec3d n(kAxis), s = normalize(cross(n, Vec3d(0, 0, 1))), t = cross(n, s);
  return Vec3(n * std::cos(angle) + (s * std::cos(azimuth) + t * std::sin(azimuth)) * std::sin(angle));
}

/// Radiant intensity in that direction over the light's own: irradiance times the distance squared.
double falloff(const SpotLight& light, Vec3 direction, float distance = 2) {
  const IncidentLight in = light.incident(light.sample_point({0.5f, 0.5f}), kTip + direction * distance);
  return double(in.irradiance.r) * double(in.distance) * double(in.distance) / 8;
}

TEST(SpotLight, ShinesFromItsTip) {
  const SpotLight light = kCones[0].light();
  const LightPoint point = light.sample_point({0.2f, 0.9f});
  EXPECT_EQ(point.kind, LightPoint::Kind::Finite);
  EXPECT_EQ(point.position, kTip);
  const IncidentLight in = light.incident(point, kTip + kAxis * 2.0f);
  EXPECT_NEAR(in.distance, 2, 1e-6f);
  EXPECT_NEAR(length(in.wi + kAxis), 0, 1e-6f);
  EXPECT_NEAR(in.irradiance.r, 2, 1e-5f);
  EXPECT_NEAR(in.irradiance.g, 1, 1e-5f);
  EXPECT_NEAR(in.irradiance.b, 0.5f, 1e-5f);
  EXPECT_EQ(in.pdf_w, 0) << "a single direction";
  EXPECT_FALSE(light.hit({kTip + kAxis * 2.0f, -kAxis})) << "a point cannot be hit";
}

TEST(SpotLight, IrradianceFallsWithTheSquareOfTheDistance) {
  const SpotLight light = kCones[0].light();
  for (const double angle : {0.0, 0.3, 0.45})
    EXPECT_NEAR(falloff(light, off_axis(angle), 0.1f), falloff(light, off_axis(angle), 50), 2e-4) << angle;
}

TEST(SpotLight, FallsFromTheInnerToTheOuterAngle) {
  for (const Cone& c : kCones) {
    const SpotLight light = c.light();
    const double outer = double(c.angle), inner = std::acos(c.cos_inner());
    // Cosines are known to 3e-7.
    const double margin = std::min(0.01, 4e-7 / std::sin(outer));
    for (const double azimuth : {0.0, 2.0, 4.5}) {
      for (const double share : {0.0, 0.3, 0.9}) {
        const double angle = share * std::max(0.0, inner - margin);
        // At blend = 1 only the axis is inside, and its cosine may round to less than 1; the step is flat there.
        EXPECT_NEAR(falloff(light, off_axis(angle, azimuth)), 1, 3e-6) << c.angle << ", " << c.blend << ": " << angle;
      }
      for (const double angle : {outer + margin, outer + 0.1, 0.5 * (outer + kPiD), kPiD})
        EXPECT_EQ(falloff(light, off_axis(angle, azimuth)), 0) << c.angle << ", " << c.blend << ": " << angle;
    }
  }
}

TEST(SpotLight, FalloffIsContinuousAndMonotoneAndASmoothStepOfTheCosine) {
  for (const Cone& c : kCones) {
    if (c.blend == 0) continue;
    const SpotLight light = c.light();
    constexpr int kSteps = 4000;
    const double range = c.cos_inner() - c.cos_outer();
    // The step has a slope of at most 1.5, and its cosine is known to 3e-7.
    const double rounding = 1.5 * 3e-7 / range + 2e-6;
    double previous = 1;
    for (int k = 0; k <= kSteps; ++k) {
      const double angle = double(c.angle) * 1.1 * k / kSteps, x = (std::cos(angle) - c.cos_outer()) / range;
      const double s = std::clamp(x, 0.0, 1.0), value = falloff(light, off_axis(angle));
      ASSERT_NEAR(value, s * s * (3 - 2 * s), rounding) << c.angle << ", " << c.blend << ": " << angle;
      ASSERT_LE(value, previous + rounding);
      ASSERT_GT(value, previous - 0.01) << "a step at " << angle;
      previous = value;
    }
  }
}

/// Checks lit_part() against incident() along the ray, but where rounding of a cosine decides. Returns whether the ray
/// is lit in part.
bool lit_where_it_shines(const Cone& c, const Ray& ray, const std::string& what) {
  const SpotLight light = c.light();
  const LightPoint point = light.sample_point({0, 0});
  const Interval lit = light.lit_part(point, ray);
  if (!lit.empty()) {
    EXPECT_GE(lit.begin, ray.span.begin) << what;
    EXPECT_LE(lit.end, ray.span.end) << what;
  }
  const float begin = ray.span.begin, end = std::min(ray.span.end, begin + 20);
  for (int k = 0; k < 60; ++k) {
    const float t = begin + (end - begin) * (static_cast<float>(k) + 0.5f) / 60;
    const Vec3d v = Vec3d(ray.at(t)) - Vec3d(kTip);
    const double distance = length(v);
    if (distance < 1e-3) continue;
    // The cosine is known to 4e-7, and the position to 3e-7 of the coordinates that it was added up from.
    const double along = dot(v, Vec3d(kAxis)), angle = std::atan2(length(cross(v, Vec3d(kAxis))), along);
    const double position = 3e-7 * (double(length(ray.origin)) + double(t));
    if (std::abs(angle - double(c.angle)) < 4e-7 / std::sin(double(c.angle)) + position / distance) continue;
    const bool inside = !lit.empty() && t >= lit.begin && t <= lit.end;
    EXPECT_EQ(inside, light.incident(point, ray.at(t)).irradiance.r > 0)
        << what << ": angle " << c.angle << ", t = " << t << " at the angle " << angle << ", lit " << lit.begin
        << " to " << lit.end;
    if (testing::Test::HasFailure()) return false;
  }
  return !lit.empty() && (lit.begin > ray.span.begin || lit.end < ray.span.end);
}

TEST(SpotLight, LitPartIsExactlyWhereItGivesLight) {
  for (const Cone& c : kCones) {
    int partly = 0;
    for (std::uint32_t i = 0; i < 4000; ++i) {
      const Vec2 a = random_pair(i, 1), b = random_pair(i, 2);
      // Half of the rays go to some place within the cone: a narrow one would hardly be met by chance.
      const Vec3 origin = kTip + uniform_sphere(a) * (10 * b.x);
      const Vec3 target = kTip + off_axis(double(c.angle) * double(random_pair(i, 3).x), 6 * double(b.y)) * (5 * b.x);
      const Vec3 direction = i % 2 ? uniform_sphere(random_pair(i, 4)) : normalize(target - origin);
      if (!is_finite(direction)) continue;
      const float end = i % 3 ? 8.0f : std::numeric_limits<float>::infinity();
      partly += lit_where_it_shines(c, {origin, direction, {0, end}}, "ray " + std::to_string(i));
      ASSERT_FALSE(HasFailure());
    }
    EXPECT_GT(partly, 1000) << "the rays hardly cross the cone of " << c.angle;
  }
}

TEST(SpotLight, LitPartOfRaysThroughTheTip) {
  for (const Cone& c : kCones)
    for (std::uint32_t i = 0; i < 500; ++i) {
      const Vec3 direction = uniform_sphere(random_pair(i));
      lit_where_it_shines(c, {kTip - direction * 4.0f, direction, {0, 9}}, "through the tip");
      lit_where_it_shines(c, {kTip, direction, {0, 9}}, "from the tip");
      const double angle = double(c.angle) * (i % 2 ? 0.98 : 0.5);
      lit_where_it_shines(c, {kTip - off_axis(angle) * 4.0f, off_axis(angle), {0, 9}},
                          "through the tip, into the cone");
      lit_where_it_shines(c, {kTip + off_axis(angle) * 4.0f, -off_axis(angle), {0, 9}}, "out of the cone by the tip");
      ASSERT_FALSE(HasFailure());
    }
}

TEST(SpotLight, LitPartOfRaysAlongTheAxisAndAcrossIt) {
  for (const Cone& c : kCones)
    for (const float away : {0.0f, 0.01f, 0.5f, 3.0f})
      for (const float along : {-4.0f, 0.0f, 2.0f})
        for (int k = 0; k < 8; ++k) {
          const Vec3 side = off_axis(kPiD / 2, k), origin = kTip + side * away + kAxis * along;
          for (const Vec3 direction : {kAxis, -kAxis, side, -side, off_axis(kPiD / 2, k + kPiD / 2)})
            lit_where_it_shines(c, {origin, direction, {0, 9}}, "along or across the axis");
          ASSERT_FALSE(HasFailure());
        }
  // Behind the tip, in the mirrored cone, there is nothing.
  const SpotLight light = kCones[0].light();
  EXPECT_TRUE(light.lit_part(light.sample_point({}), {kTip - kAxis * 5.0f, off_axis(kPiD / 2), {0, 9}}).empty());
  EXPECT_TRUE(light.lit_part(light.sample_point({}), {kTip - kAxis * 5.0f, -kAxis, {0, 9}}).empty());
}

TEST(SpotLight, LitPartOfRaysParallelToTheEdge) {
  // The quadratic loses its square term; what is left of it by rounding must not decide.
  for (const Cone& c : kCones)
    for (std::uint32_t i = 0; i < 500; ++i) {
      const Vec2 u = random_pair(i, 1);
      const Vec3 edge = off_axis(double(c.angle) + (i % 5 - 2.0) * 1e-7, 6 * double(u.x));
      const Vec3 aside = uniform_sphere(random_pair(i)) * (2 * u.y);
      lit_where_it_shines(c, {kTip + aside - edge * 4.0f, edge, {0, 9}}, "parallel to the edge");
      lit_where_it_shines(c, {kTip + aside + edge * 4.0f, -edge, {0, 9}}, "parallel to the edge, backwards");
      ASSERT_FALSE(HasFailure());
    }
}

TEST(SpotLight, LitPartOfRaysFromFarAway) {
  // A camera 100 away that looks at the cone about one unit from its tip. The ray's direction is unit only to 1e-7, and
  // what that adds to |v|^2 = 1 is 1e-7 * 100^2 = 1e-3, more than the squared sine of a narrow cone.
  for (const Cone& c : kCones)
    for (std::uint32_t i = 0; i < 2000; ++i) {
      const Vec2 u = random_pair(i);
      const Vec3 target = kTip + off_axis(double(c.angle) * 1.5 * double(u.x), 6 * double(u.y)) * (0.5f + u.y);
      const Vec3 direction = uniform_sphere(random_pair(i, 1));
      lit_where_it_shines(c, {target - direction * 100.0f, direction, {98, 102}}, "from far away");
      ASSERT_FALSE(HasFailure());
    }
}

TEST(SpotLight, AConeOfRightAngleIsAHalfSpace) {
  // An axis without rounding, so that the plane through the tip is exact.
  const SpotLight light({0, 0, 0}, {0, 0, -1}, kPi / 2, 0.3f, Color(1));
  const LightPoint point = light.sample_point({});
  const Interval down = light.lit_part(point, {{3, -2, 4}, {0, 0, -1}, {0, 10}});
  EXPECT_NEAR(down.begin, 4, 1e-6f);
  EXPECT_EQ(down.end, 10);
  const Interval up = light.lit_part(point, {{3, -2, -4}, {0, 0, 1}, {0, 10}});
  EXPECT_EQ(up.begin, 0);
  EXPECT_NEAR(up.end, 4, 1e-6f);
  const Interval below = light.lit_part(point, {{-3, 1, -0.5f}, {1, 0, 0}, {0, 10}});
  EXPECT_TRUE(below.begin == 0 && below.end == 10);
  EXPECT_TRUE(light.lit_part(point, {{-3, 1, 0.5f}, {1, 0, 0}, {0, 10}}).empty());
  EXPECT_GT(light.incident(point, {1, 0, -0.01f}).irradiance.r, 0);
  EXPECT_EQ(light.incident(point, {1, 0, 0.01f}).irradiance.r, 0);
}

TEST(SpotLight, TotalPowerIsTheIntegralOfItsIntensity) {
  const double z = sidak_z(1e-3, static_cast<int>(std::size(kCones)));
  for (const Cone& c : kCones) {
    const SpotLight light = c.light();
    // Over the cosines of a somewhat wider cone.
    const double spread = std::min(2.0, 1.2 * (1 - c.cos_outer()));
    RunningMean power;
    for (std::uint32_t i = 0; i < 100000; ++i) {
      const Vec2 u = random_pair(i);
      const double angle = 2 * std::asin(std::sqrt(0.5 * spread * double(u.x)));
      power.add(falloff(light, off_axis(angle, 2 * kPiD * double(u.y))) * 2 * kPiD * spread);
    }
    const double blend = c.cos_inner() - c.cos_outer();
    const double falling =
        integrate([&](double x) { return 2 * kPiD * blend * x * x * (3 - 2 * x); }, 0, 1, 4);  // half of its range
    const double expected = 2 * kPiD * (1 - c.cos_inner()) + falling;
    // The cosines of a narrow cone are known to 6e-8 of 1 - cos.
    const double rounding = expected * (1e-5 + 1.2e-7 / (1 - c.cos_outer()));
    EXPECT_NEAR(power.mean(), expected, z * power.standard_error() + rounding) << c.angle << ", " << c.blend;
  }
}

/// The narrowest cone that a scene file can ask for is 0.05 degrees: 1 - cos = 3.8e-7, a few of a float's spacings
/// at 1.
TEST(SpotLight, AVeryNarrowConeKeepsItsWidth) {
  for (const float degrees : {1.0f, 0.3f, 0.1f, 0.05f}) {
    const double angle = double(degrees) * kPiD / 180;
    const SpotLight light({0, 0, 0}, {0, 0, -1}, static_cast<float>(angle), 0, Color(1));
    const LightPoint point = light.sample_point({});
    EXPECT_GT(light.incident(point, {0, 0, -100}).irradiance.r, 0) << degrees << " degrees: dark on its axis";
    const auto at = [&](double share) { return Vec3(static_cast<float>(100 * std::tan(share * angle)), 0, -100); };
    EXPECT_GT(light.incident(point, at(0.9)).irradiance.r, 0) << degrees << " degrees: dark inside";
    EXPECT_EQ(light.incident(point, at(1.1)).irradiance.r, 0) << degrees << " degrees: light outside";
    const Interval lit = light.lit_part(point, {at(1) * 2.0f, {-1, 0, 0}, {0, 10}});
    EXPECT_NEAR(lit.end - lit.begin, 4e2 * std::tan(angle), 40 * std::tan(angle)) << degrees << " degrees";
  }
}

}  // namespace
}  // namespace brume
