#include "renderer/lights/directional_light.h"

#include <gtest/gtest.h>

#include <vector>

#include "renderer/sampling/sampler.h"
#include "tests/support/statistics.h"

namespace brume {
namespace {

constexpr double kPiD = 3.14159265358979323846;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kDegree = kPi / 180;
constexpr float kDiameters[] = {0.53f, 10, 180};
const Vec3 kTravel = normalize(Vec3(1, 2, -2));
const Color kIrradiance{3, 2, 1};

Vec2 random_pair(std::uint32_t i, int index = 0) {
  return Sampler(SamplerKind::Independent, 16, 3, i).u2(Decision::LightPoint, 0, index);
}

DirectionalLight sun(float degrees) { return {kTravel, kIrradiance, degrees * kDegree}; }

/// 1 - cos of the disc's radius.
double spread_of(float degrees) { return 2 * std::pow(std::sin(double(degrees) * kPiD / 720), 2); }

/// 1 - cos of the angle between the middle of the disc and w, without cancellation.
double from_middle(Vec3 w) { return 0.5 * length_squared(normalize(Vec3d(w)) + normalize(Vec3d(kTravel))); }

/// A direction with the given 1 - cos to the middle of the disc.
Vec3 off_middle(double one_minus_cos, double azimuth) {
  const Vec3d n = -normalize(Vec3d(kTravel)), s = normalize(cross(n, Vec3d(0, 0, 1))), t = cross(n, s);
  const double r = std::sqrt(one_minus_cos * (2 - one_minus_cos));
  return Vec3(n * (1 - one_minus_cos) + (s * std::cos(azimuth) + t * std::sin(azimuth)) * r);
}

TEST(SunLight, DirectionsAreUniformInTheDisc) {
  constexpr int kN = 50000, kBins = 12;
  for (const float degrees : kDiameters) {
    const DirectionalLight light = sun(degrees);
    const Vec3d n = -Vec3d(kTravel), s = normalize(cross(n, Vec3d(0, 0, 1))), t = cross(n, s);
    std::vector<double> observed(kBins * kBins), expected(observed.size(), double(kN) / (kBins * kBins));
    for (std::uint32_t i = 0; i < kN; ++i) {
      const LightPoint point = light.sample_point(random_pair(i));
      ASSERT_EQ(point.kind, LightPoint::Kind::Distant);
      ASSERT_NEAR(length(point.direction), 1, 4e-7f);
      // Directions are rounded by 1e-7, which is 2e-5 of the sun's radius.
      const double share = from_middle(point.direction) / spread_of(degrees);
      ASSERT_LE(share, 1 + 1e-4);
      const double angle =
          std::atan2(dot(Vec3d(point.direction), t), dot(Vec3d(point.direction), s)) / (2 * kPiD) + 0.5;
      ++observed[std::min<std::size_t>(kBins - 1, static_cast<std::size_t>(share * kBins)) * kBins +
                 std::min<std::size_t>(kBins - 1, static_cast<std::size_t>(angle * kBins))];
    }
    EXPECT_GT(chi_square_p_value(observed, expected), kChiSquareSignificance) << degrees << " degrees";
  }
}

TEST(SunLight, SampledIrradianceOnAFacingPlaneIsTheGivenOne) {
  const double z = sidak_z(1e-3, static_cast<int>(std::size(kDiameters)));
  for (const float degrees : kDiameters) {
    const DirectionalLight light = sun(degrees);
    RunningMean irradiance;
    for (std::uint32_t i = 0; i < 50000; ++i) {
      const IncidentLight in = light.incident(light.sample_point(random_pair(i)), {5, 5, 5});
      ASSERT_EQ(in.distance, kInfinity);
      ASSERT_FLOAT_EQ(in.irradiance.b, in.irradiance.r / 3);
      irradiance.add(double(in.irradiance.r) * -double(dot(in.wi, kTravel)));
    }
    EXPECT_NEAR(irradiance.mean(), 3, z * irradiance.standard_error() + 2e-6) << degrees << " degrees";
  }
}

TEST(SunLight, IrradianceFromHitsOnAFacingPlaneIsTheGivenOneAndTheirDensityIsOne) {
  const double z = sidak_z(1e-3, 2 * static_cast<int>(std::size(kDiameters)));
  for (const float degrees : kDiameters) {
    const DirectionalLight light = sun(degrees);
    const double spread = 1.3 * spread_of(degrees);  // directions around the disc, too
    RunningMean irradiance, density;
    for (std::uint32_t i = 0; i < 100000; ++i) {
      const Vec2 u = random_pair(i);
      const double one_minus_cos = spread * double(u.x);
      const auto hit = light.hit({{1, 2, 3}, off_middle(one_minus_cos, 2 * kPiD * double(u.y))});
      irradiance.add(hit ? double(hit->radiance.r) * (1 - one_minus_cos) * 2 * kPiD * spread : 0);
      density.add(hit ? double(hit->pdf_w) * 2 * kPiD * spread : 0);
    }
    EXPECT_NEAR(irradiance.mean(), 3, z * irradiance.standard_error()) << degrees << " degrees";
    EXPECT_NEAR(density.mean(), 1, z * density.standard_error()) << degrees << " degrees";
  }
}

TEST(SunLight, HitAgreesWithIncident) {
  for (const float degrees : kDiameters) {
    const DirectionalLight light = sun(degrees);
    EXPECT_NEAR(light.solid_angle({1, 2, 3}) / (2 * kPiD * spread_of(degrees)), 1, 1e-6);
    for (std::uint32_t i = 0; i < 5000; ++i) {
      const LightPoint point = light.sample_point(random_pair(i));
      const IncidentLight in = light.incident(point, {});
      EXPECT_EQ(in.wi, point.direction);
      if (from_middle(point.direction) > 0.999 * spread_of(degrees)) continue;  // rounding decides whether it hits
      const auto hit = light.hit({{}, point.direction});
      ASSERT_TRUE(hit) << degrees << " degrees";
      EXPECT_EQ(hit->t, kInfinity);
      EXPECT_EQ(hit->pdf_w, in.pdf_w);
      EXPECT_NEAR(in.irradiance.g * in.pdf_w / hit->radiance.g, 1, 1e-6);
      EXPECT_EQ(hit->point.kind, LightPoint::Kind::Distant);
      EXPECT_EQ(light.incident(hit->point, {}).pdf_w, in.pdf_w);
    }
  }
}

TEST(SunLight, IsSeenInsideItsDiscByRaysThatEndNowhere) {
  for (const float degrees : kDiameters) {
    const DirectionalLight light = sun(degrees);
    for (const double azimuth : {0.0, 1.0, 2.0, 4.0}) {
      EXPECT_TRUE(light.hit({{}, off_middle(0.99 * spread_of(degrees), azimuth)})) << degrees;
      EXPECT_FALSE(light.hit({{}, off_middle(1.01 * spread_of(degrees), azimuth)})) << degrees;
    }
    EXPECT_TRUE(light.hit({{7, 8, 9}, -kTravel}));
    EXPECT_FALSE(light.hit({{}, kTravel})) << "on the other side";
    EXPECT_FALSE(light.hit({{}, -kTravel, {0, 1e6f}})) << "infinitely far away";
    // The whole ray can be lit from there.
    const Interval lit = light.lit_part(light.sample_point({0.1f, 0.2f}), {{}, {0, 1, 0}, {1, 4}});
    EXPECT_TRUE(lit.begin == 1 && lit.end == 4);
  }
}

TEST(SunLight, RadianceOfHalfTheSkyIsTheIrradianceOverPi) {
  EXPECT_NEAR(sun(180).hit({{}, -kTravel})->radiance.r, 3 / kPiD, 1e-6);
  EXPECT_NEAR(sun(180).solid_angle({}), 2 * kPiD, 1e-6);
}

TEST(SunLight, WithoutASizeItIsASingleDirectionThatCannotBeHit) {
  for (const DirectionalLight& light : {DirectionalLight(kTravel, kIrradiance), sun(0)}) {
    for (std::uint32_t i = 0; i < 100; ++i) {
      const LightPoint point = light.sample_point(random_pair(i));
      EXPECT_EQ(point.direction, -kTravel);
      const IncidentLight in = light.incident(point, {1, 2, 3});
      EXPECT_EQ(in.wi, -kTravel);
      EXPECT_EQ(in.irradiance, kIrradiance);
      EXPECT_EQ(in.pdf_w, 0);
    }
    EXPECT_FALSE(light.hit({{}, -kTravel}));
    EXPECT_EQ(light.solid_angle({}), 0);
  }
}

TEST(SunLight, EndsOfTheUnitSquareStayInTheDisc) {
  for (const float degrees : kDiameters)
    for (const float x : {0.0f, 0x1.fffffep-1f})
      for (const float y : {0.0f, 0x1.fffffep-1f}) {
        const Vec3 w = sun(degrees).sample_point({x, y}).direction;
        EXPECT_NEAR(length(w), 1, 4e-7f);
        EXPECT_LE(from_middle(w), spread_of(degrees) * (1 + 1e-4));
      }
}

}  // namespace
}  // namespace brume
