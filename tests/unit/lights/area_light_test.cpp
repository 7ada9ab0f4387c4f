#include "renderer/lights/area_light.h"

#include <gtest/gtest.h>

#include <vector>

#include "renderer/lights/disc_light.h"
#include "renderer/lights/sphere_light.h"
#include "renderer/sampling/sampler.h"
#include "tests/support/statistics.h"

namespace brume {
namespace {

constexpr double kPiD = 3.14159265358979323846;

Vec2 random_pair(std::uint32_t i, int index = 0) {
  return Sampler(SamplerKind::Independent, 14, 6, i).u2(Decision::LightPoint, 0, index);
}

// Tilted and off the origin.
const Vec3 kCenter{1, -2, 3}, kNormal = normalize(Vec3(2, -1, 2));
constexpr float kRadius = 0.75f;
const Color kRadiance{2, 1, 0.5f};

DiscLight disc(bool two_sided = false) { return {kCenter, kNormal, kRadius, kRadiance, two_sided}; }
SphereLight sphere() { return {kCenter, kRadius, kRadiance}; }

/// Solid angle of the cone that a sphere fills.
double cone_sr(double radius, double distance) {
  return 2 * kPiD * (1 - std::sqrt(1 - radius * radius / (distance * distance)));
}

/// Solid angle of a disc seen from the height h over its middle.
double disc_sr(double radius, double h) { return 2 * kPiD * (1 - h / std::hypot(h, radius)); }

/// A direction at most acos(1 - one_minus_cos) from `axis`, in double: nothing of the renderer's own warps.
Vec3 in_cone(Vec3 axis, double one_minus_cos, double u) {
  const Vec3d n = normalize(Vec3d(axis)),
              s = normalize(cross(n, std::abs(n.x) < 0.5 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0)));
  const double r = std::sqrt(one_minus_cos * (2 - one_minus_cos)), phi = 2 * kPiD * u;
  return Vec3(n * (1 - one_minus_cos) + s * (r * std::cos(phi)) + cross(n, s) * (r * std::sin(phi)));
}

TEST(DiscLight, PointsAreUniformOverTheArea) {
  const DiscLight light = disc();
  const Vec3 s = normalize(cross(kNormal, Vec3(0, 0, 1))), t = cross(kNormal, s);
  constexpr int kN = 50000, kBins = 12;
  std::vector<double> observed(kBins * kBins), expected(observed.size(), double(kN) / (kBins * kBins));
  for (std::uint32_t i = 0; i < kN; ++i) {
    const LightPoint point = light.sample_point(random_pair(i));
    EXPECT_EQ(point.kind, LightPoint::Kind::Finite);
    EXPECT_EQ(point.normal, kNormal);
    const Vec3 p = (point.position - kCenter) / kRadius;
    ASSERT_NEAR(dot(p, kNormal), 0, 2e-6f) << "not in the plane";
    const double area = double(length_squared(p)), angle = std::atan2(double(dot(p, t)), double(dot(p, s)));
    ASSERT_LE(area, 1 + 3e-6);
    ++observed[std::min<std::size_t>(kBins - 1, static_cast<std::size_t>(area * kBins)) * kBins +
               std::min<std::size_t>(kBins - 1, static_cast<std::size_t>((angle / (2 * kPiD) + 0.5) * kBins))];
  }
  EXPECT_GT(chi_square_p_value(observed, expected), kChiSquareSignificance);
}

TEST(SphereLight, PointsAreUniformOverTheAreaAndFaceOutwards) {
  const SphereLight light = sphere();
  constexpr int kN = 50000, kBins = 12;
  std::vector<double> observed(kBins * kBins), expected(observed.size(), double(kN) / (kBins * kBins));
  for (std::uint32_t i = 0; i < kN; ++i) {
    const LightPoint point = light.sample_point(random_pair(i));
    const Vec3 p = (point.position - kCenter) / kRadius;
    ASSERT_NEAR(length(p), 1, 2e-6f);
    ASSERT_NEAR(length(p - point.normal), 0, 2e-6f);
    // Equal steps of one coordinate have equal areas (Archimedes).
    const double angle = std::atan2(double(p.y), double(p.x)) / (2 * kPiD) + 0.5;
    ++observed[std::min<std::size_t>(kBins - 1, static_cast<std::size_t>((0.5 + 0.5 * double(p.z)) * kBins)) * kBins +
               std::min<std::size_t>(kBins - 1, static_cast<std::size_t>(angle * kBins))];
  }
  EXPECT_GT(chi_square_p_value(observed, expected), kChiSquareSignificance);
}

TEST(DiscLight, MeanIrradianceIsRadianceTimesSolidAngleAndNothingIsBehind) {
  // On a plane that faces the light point, so the mean is Le times the plain solid angle.
  const double z = sidak_z(1e-3, 6);
  for (const float h : {0.1f, 0.5f, 4.0f}) {
    RunningMean front, back;
    for (std::uint32_t i = 0; i < 50000; ++i) {
      const LightPoint point = disc().sample_point(random_pair(i));
      const IncidentLight in = disc().incident(point, kCenter + kNormal * h);
      ASSERT_NEAR(length(in.wi), 1, 4e-7f);
      ASSERT_NEAR(in.distance, length(point.position - (kCenter + kNormal * h)), 1e-5f);
      ASSERT_FLOAT_EQ(in.irradiance.g, 0.5f * in.irradiance.r);
      front.add(double(in.irradiance.r));
      const IncidentLight behind = disc().incident(point, kCenter - kNormal * h);
      ASSERT_TRUE(is_black(behind.irradiance) && behind.pdf_w == 0) << "light behind a one-sided disc";
      const LightPoint of_both = disc(true).sample_point(random_pair(i));
      back.add(double(disc(true).incident(of_both, kCenter - kNormal * h).irradiance.r));
    }
    const double expected = 2 * disc_sr(double(kRadius), double(h));
    EXPECT_NEAR(front.mean(), expected, z * front.standard_error() + 1e-6) << "h = " << h;
    EXPECT_NEAR(back.mean(), expected, z * back.standard_error() + 1e-6) << "h = " << h;
  }
}

TEST(SphereLight, MeanIrradianceIsRadianceTimesSolidAngle) {
  const double z = sidak_z(1e-3, 4);
  for (const float d : {0.76f, 1.0f, 3.0f, 100.0f}) {
    RunningMean mean;
    const Vec3 x = kCenter + normalize(Vec3(1, 2, -3)) * d;
    for (std::uint32_t i = 0; i < 100000; ++i) {
      const LightPoint point = sphere().sample_point(random_pair(i));
      const IncidentLight in = sphere().incident(point, x);
      ASSERT_EQ(in.irradiance.r > 0, dot(x - point.position, point.normal) > 0);
      mean.add(double(in.irradiance.r));
    }
    const double exact = double(length(x - kCenter));
    EXPECT_NEAR(mean.mean() / (2 * cone_sr(double(kRadius), exact)), 1, z * mean.standard_error() / mean.mean() + 1e-5)
        << "d = " << d;
  }
}

TEST(AreaLight, LitPartIsExactlyWhereItsPointsGiveLight) {
  const DiscLight one = disc(), two = disc(true);
  const SphereLight ball = sphere();
  int crossings = 0;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const Vec2 a = random_pair(i, 1), b = random_pair(i, 2);
    const Ray ray{kCenter + Vec3(10 * b.y - 5, 10 * a.x - 5, 10 * a.y - 5),
                  normalize(Vec3(a.x - 0.5f, a.y - 0.5f, b.x - 0.5f)),
                  {0, 8}};
    for (const AreaLight* light : {static_cast<const AreaLight*>(&one), static_cast<const AreaLight*>(&ball)}) {
      const LightPoint point = light->sample_point(random_pair(i));
      const Interval lit = light->lit_part(point, ray);
      if (!lit.empty() && (lit.begin > 0 || lit.end < 8)) ++crossings;
      for (int k = 0; k < 50; ++k) {
        const float t = 8 * (static_cast<float>(k) + 0.5f) / 50;
        if (std::abs(dot(ray.at(t) - point.position, point.normal)) < 1e-4f) continue;  // rounding decides
        const bool inside = !lit.empty() && t >= lit.begin && t <= lit.end;
        ASSERT_EQ(inside, light->incident(point, ray.at(t)).irradiance.r > 0) << "ray " << i << ", t = " << t;
      }
    }
    const Interval all = two.lit_part(two.sample_point(random_pair(i)), ray);
    ASSERT_TRUE(all.begin == 0 && all.end == 8);
  }
  EXPECT_GT(crossings, 200) << "the rays hardly cross the planes";
}

TEST(AreaLight, ARayAlongThePlaneIsLitOnOneSideOnly) {
  const DiscLight light({0, 0, 0}, {0, 0, 1}, 1, Color(1), false);
  const LightPoint point = light.sample_point({0.5f, 0.5f});
  EXPECT_FALSE(light.lit_part(point, {{-3, 0, 0.5f}, {1, 0, 0}, {0, 5}}).empty());
  EXPECT_TRUE(light.lit_part(point, {{-3, 0, -0.5f}, {1, 0, 0}, {0, 5}}).empty());
  EXPECT_TRUE(light.lit_part(point, {{-3, 0, 0}, {1, 0, 0}, {0, 5}}).empty());
  EXPECT_FALSE(light.hit({{-3, 0, 0}, {1, 0, 0}, {0, 5}})) << "seen edge on";
}

/// What a ray towards a drawn point sees there: the two ways of counting the same light must weigh against each other.
TEST(AreaLight, HitAgreesWithIncident) {
  const DiscLight one = disc(), two = disc(true);
  const SphereLight ball = sphere();
  const AreaLight* const lights[] = {&one, &two, &ball};
  int lit = 0, dark = 0;
  for (std::uint32_t i = 0; i < 20000; ++i) {
    const AreaLight& light = *lights[i % 3];
    const Vec2 a = random_pair(i, 1), b = random_pair(i, 2);
    const Vec3 x = kCenter + normalize(Vec3(a.x - 0.5f, a.y - 0.5f, b.x - 0.5f)) * (kRadius * (1.01f + 9 * b.y));
    const Vec2 u = random_pair(i);
    const LightPoint point = light.sample_point(u);
    const IncidentLight in = light.incident(point, x);
    const float cosine = -dot(in.wi, point.normal);
    if (std::abs(cosine) < 0.02f || (&light != &ball && u.x > 0.9999f)) continue;  // rounding decides whether it hits
    const auto hit = light.hit({x, in.wi});
    if (is_black(in.irradiance)) {
      ++dark;
      // Behind a disc nothing is seen; the far side of a sphere is hidden by its near side.
      if (&light == &ball) {
        ASSERT_TRUE(hit && hit->t < in.distance) << i;
      } else {
        ASSERT_FALSE(hit) << i;
      }
      continue;
    }
    ++lit;
    ASSERT_TRUE(hit) << i;
    EXPECT_EQ(hit->radiance, kRadiance);
    // The direction is rounded by 1e-7, which at the distance d moves the point by 1e-7 d / cos along the surface and,
    // on the sphere, turns its normal by that over r: d/r is up to 10.
    const double tolerance = 2e-6 + 3e-6 / double(cosine * cosine);
    EXPECT_NEAR(hit->t / in.distance, 1, tolerance) << i;
    EXPECT_NEAR(length(hit->point.position - point.position), 0, 10 * tolerance) << i;
    EXPECT_NEAR(length(hit->point.normal - point.normal), 0, 10 * tolerance) << i;
    EXPECT_NEAR(hit->pdf_w / in.pdf_w, 1, tolerance) << i;
    EXPECT_NEAR(in.irradiance.r * in.pdf_w / hit->radiance.r, 1, 2e-6) << i;
    const IncidentLight back = light.incident(hit->point, x);
    EXPECT_NEAR(back.pdf_w / hit->pdf_w, 1, tolerance) << "the hit's own point is one that sample_point() could give";
    EXPECT_FALSE(light.hit({x, in.wi, {0, 0.99f * hit->t}})) << "beyond the span";
    EXPECT_FALSE(light.hit({x, in.wi, {1.01f * in.distance, &light == &ball ? 1.02f * in.distance : 1e9f}}))
        << "before the span";
    EXPECT_FALSE(light.hit({x, -in.wi})) << "away from it";
  }
  EXPECT_GT(lit, 7000);
  EXPECT_GT(dark, 3000);
}

TEST(DiscLight, DensityOfHitsIsOneAndTheirRadianceIsTheMeanIrradiance) {
  const double z = sidak_z(1e-3, 12);
  for (const bool two_sided : {false, true}) {
    const DiscLight light = disc(two_sided);
    for (const Vec3 at : {Vec3(0.1f, 0.2f, 1), Vec3(1, 0.5f, 0.6f), Vec3(-3, 2, two_sided ? -4.0f : 4.0f)}) {
      const Vec3 s = normalize(cross(kNormal, Vec3(0, 0, 1)));
      const Vec3 x = kCenter + s * at.x + cross(kNormal, s) * at.y + kNormal * at.z;
      // Directions in a cone around the sphere about the disc, or from inside that sphere all directions.
      const double ratio = double(kRadius) / double(length(x - kCenter));
      const double spread = ratio < 0.99 ? 1 - std::sqrt(1 - 1.01 * ratio * ratio) : 2;
      RunningMean density, radiance, irradiance;
      for (std::uint32_t i = 0; i < 100000; ++i) {
        const Vec2 u = random_pair(i, 1);
        const auto hit = light.hit({x, in_cone(kCenter - x, spread * double(u.x), double(u.y))});
        density.add(hit ? double(hit->pdf_w) * 2 * kPiD * spread : 0);
        radiance.add(hit ? double(hit->radiance.r) * 2 * kPiD * spread : 0);
        irradiance.add(double(light.incident(light.sample_point(random_pair(i)), x).irradiance.r));
      }
      EXPECT_NEAR(density.mean(), 1, z * density.standard_error()) << at.x;
      EXPECT_NEAR(radiance.mean(), irradiance.mean(),
                  z * std::hypot(radiance.standard_error(), irradiance.standard_error()))
          << at.x;
    }
  }
}

TEST(SphereLight, DensityOfHitsIsTheVisibleShareAndTheirRadianceTheSolidAngle) {
  const double z = sidak_z(1e-3, 6);
  for (const float d : {0.8f, 2.0f, 20.0f}) {
    const Vec3 x = kCenter + normalize(Vec3(-1, 2, 2)) * d;
    const double exact = double(length(x - kCenter)), r = double(kRadius), spread = cone_sr(r, exact) / (2 * kPiD);
    RunningMean density, radiance;
    for (std::uint32_t i = 0; i < 100000; ++i) {
      // The density grows as 1/cos towards the rim, so that its square has no integral. 1 - cos = spread (1 - v^2)
      // with a uniform v has just as many directions there: weight 4 pi spread v.
      const Vec2 u = random_pair(i);
      const double v = double(u.x);
      const auto hit = sphere().hit({x, in_cone(kCenter - x, spread * (1 - v * v), double(u.y))});
      density.add(hit ? double(hit->pdf_w) * 4 * kPiD * spread * v : 0);
      radiance.add(hit ? double(hit->radiance.r) * 4 * kPiD * spread * v : 0);
    }
    // The cap that is seen has the height r - r^2/d of 2 r. Rounding closes the last 1e-3 of the rim.
    EXPECT_NEAR(density.mean(), 0.5 * (1 - r / exact), z * density.standard_error() + 1e-4) << "d = " << d;
    EXPECT_NEAR(radiance.mean() / (2 * cone_sr(r, exact)), 1, z * radiance.standard_error() / radiance.mean() + 1e-4)
        << "d = " << d;
  }
}

TEST(DiscLight, RaysHitItInsideItsRim) {
  const Vec3 s = normalize(cross(kNormal, Vec3(0, 0, 1)));
  for (const float r : {0.0f, 0.5f, 0.999f}) EXPECT_TRUE(disc().hit({kCenter + s * (r * kRadius) + kNormal, -kNormal}));
  for (const float r : {1.001f, 2.0f}) EXPECT_FALSE(disc().hit({kCenter + s * (r * kRadius) + kNormal, -kNormal}));
  EXPECT_FALSE(disc().hit({kCenter - kNormal, kNormal})) << "from behind";
  EXPECT_TRUE(disc(true).hit({kCenter - kNormal, kNormal}));
}

TEST(SphereLight, RaysHitItsOutsideOnly) {
  const Vec3 n = normalize(Vec3(1, 1, -1)), s = normalize(cross(n, Vec3(0, 0, 1)));
  EXPECT_NEAR(sphere().hit({kCenter + n * 3.0f, -n})->t, 3 - kRadius, 1e-6f);
  EXPECT_TRUE(sphere().hit({kCenter + n * 3.0f + s * (0.999f * kRadius), -n}));
  EXPECT_FALSE(sphere().hit({kCenter + n * 3.0f + s * (1.001f * kRadius), -n}));
  EXPECT_FALSE(sphere().hit({kCenter, n})) << "from inside";
  EXPECT_FALSE(sphere().hit({kCenter + n * 3.0f, n})) << "away from it";
}

TEST(SphereLight, KeepsItsShapeFarAway) {
  // r/d = 1e-4: in float r^2 would be lost in d^2.
  const SphereLight small({0, 0, 1000}, 0.1f, Color(1));
  for (const float h : {0.0f, 0.05f, 0.0999f}) {
    const auto hit = small.hit({{h, 0, 0}, {0, 0, 1}});
    ASSERT_TRUE(hit) << h;
    const float cosine = std::sqrt(1 - 100 * h * h);
    EXPECT_NEAR(hit->point.normal.x, 10 * h, 1e-5f);
    EXPECT_NEAR(hit->point.normal.z, -cosine, 1e-4f);
    EXPECT_NEAR(hit->t, 1000 - 0.1f * cosine, 1e-4f);
  }
  EXPECT_FALSE(small.hit({{0.1001f, 0, 0}, {0, 0, 1}}));
}

/// Only a choice between techniques hangs on it: within a factor of 2 where the light is seen face on.
TEST(AreaLight, SolidAngleIsRoughlyRight) {
  for (const float d : {0.8f, 1.5f, 5.0f, 100.0f}) {
    const Vec3 x = kCenter + kNormal * d;
    const double of_disc = double(disc().solid_angle(x)) / disc_sr(double(kRadius), double(d));
    EXPECT_TRUE(of_disc > 0.5 && of_disc < 2) << "disc at " << d << ": " << of_disc << " times too large";
    const double of_sphere = double(sphere().solid_angle(x)) / cone_sr(double(kRadius), double(d));
    EXPECT_TRUE(of_sphere > 0.5 && of_sphere < 2) << "sphere at " << d << ": " << of_sphere << " times too large";
  }
  EXPECT_TRUE(std::isfinite(disc().solid_angle(kCenter)));
  EXPECT_LE(sphere().solid_angle(kCenter), 4 * kPi);
}

TEST(AreaLight, LooksLargestFromTheNearestPointOfARayOrABox) {
  const std::unique_ptr<Light> lights[] = {std::make_unique<DiscLight>(disc()),
                                           std::make_unique<SphereLight>(sphere())};
  for (const auto& light : lights)
    for (std::uint32_t i = 0; i < 200; ++i) {
      const auto place = [&](int k) {
        const Vec2 a = random_pair(i, k), b = random_pair(i, k + 1);
        return Vec3(6 * a.x - 3, 6 * a.y - 3, 6 * b.x - 3);
      };
      const Vec3 from = place(0), to = place(2);
      const Ray ray{from, normalize(to - from), {0.1f, length(to - from)}};
      const Bounds3 box{min(Vec3d(from), Vec3d(to)), max(Vec3d(from), Vec3d(to))};
      float on_ray = 0, in_box = 0;
      for (int k = 0; k <= 1000; ++k) {
        const float s = static_cast<float>(k) / 1000;
        on_ray = std::max(on_ray, light->solid_angle(ray.at(ray.span.begin + s * ray.span.length())));
        const Vec3 inside(from.x + (to.x - from.x) * random_pair(i, 10 + k).x,
                          from.y + (to.y - from.y) * random_pair(i, 10 + k).y, from.z + (to.z - from.z) * s);
        in_box = std::max(in_box, light->solid_angle(inside));
      }
      ASSERT_GE(light->largest_solid_angle(ray), on_ray * (1 - 1e-5f));
      ASSERT_LE(light->largest_solid_angle(ray), on_ray * 1.02f);
      ASSERT_GE(light->largest_solid_angle(box), in_box * (1 - 1e-5f));
    }
}

}  // namespace
}  // namespace brume
