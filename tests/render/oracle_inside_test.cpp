// O11 of the catalogue: the camera in front of, at the face of, inside and behind the medium; lamps inside it, on the
// ray and on the camera (G1, A4, A9).
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/support/effort.h"
#include "tests/support/scenes.h"

namespace brume {
namespace {

constexpr double kInv4PiD = 0.07957747154594766788;
constexpr double kSigmaT = 3, kAlbedo = 0.8;

Node scene_for(const std::string& integrator) {
  Node scene = empty_scene();
  set(scene, "render.integrator", integrator);
  set(scene, "render.sampler", "independent");
  set(scene, "render.seed", std::to_string(integrator.size()));
  return scene;
}

/// A medium from z = -1/2 to 1/2. Where it is a box, its sides are 2 : 3 : 6, so that with 15 knots per ray the shadow
/// maps of ray_march_cached have knots in its faces and are exact.
Node& add_medium(Node& scene, const char* shape, const char* shader) {
  const ParamTable& settings = scene.child("render").table();
  if (settings.find("step_size")) set(scene, "render.step_size", "0.0625");
  if (settings.find("shadow_map_resolution")) set(scene, "render.shadow_map_resolution", "15");
  Node& v = add_volume(scene, shader);
  set(v, "bounds.type", shape);
  if (std::string(shape) == "box") {
    const Numbers half{1.0 / 6, 0.25, 0.5};
    set(v, "bounds.min", format_value(Numbers{-half[0], -half[1], -half[2]}));
    set(v, "bounds.max", format_value(half));
  } else {
    set(v, "bounds.radius", "0.5");
  }
  if (std::string(shader) == "linear") set(v, "gradient", "0,0,0");  // level: marched, but the same medium
  set(v, "density_scale", format_value(kSigmaT));
  return v;
}

const float kPlaces[] = {-5.0f, -0.75f, std::nextafter(-0.5f, -1.0f), -0.5f, std::nextafter(-0.5f, 0.0f), -0.25f,
                         0.0f,  0.3f,   std::nextafter(0.5f, 0.0f),   0.5f,  std::nextafter(0.5f, 1.0f),  5.0f};
constexpr int kPlaceCount = static_cast<int>(std::size(kPlaces));

bool tracks(const std::string& integrator) {
  return integrator.starts_with("delta_tracking") || integrator == "null_scattering";
}

// What a glowing medium shows is (epsilon / sigma_t) (1 - exp(-sigma_t l)) for the length l in front of the camera:
// continuous in the camera's place. Marches are exact, tracking is so on average.
TEST(OracleInside, O11AGlowIsThatOfTheLengthInFrontOfTheCamera) {
  const double bound = sidak_z(1e-3, 3 * 4 * kPlaceCount);
  for (const IntegratorType& type : integrator_types())
    for (const char* shape : {"box", "sphere"})
      for (const char* shader : {"homogeneous", "linear"}) {
        Node description = scene_for(type.table.key);
        Node& v = add_medium(description, shape, shader);
        set(v, "albedo", "0,0,0");
        set(v, "emission_scale", "2");
        const auto scene = committed(description);
        const bool tracked = tracks(type.table.key);
        for (const float z : kPlaces) {
          const RayEstimate e = estimate(*scene, {{0, 0, z}, {0, 0, 1}}, tracked ? 20000 / kFewer : 8);
          const double in_front = std::clamp(0.5 - double(z), 0.0, 1.0);
          const double expected = 2 / kSigmaT * -std::expm1(-kSigmaT * in_front);
          const std::string what = type.table.key + ", " + shape + ", " + shader + ", camera at " + std::to_string(z);
          EXPECT_EQ(e.non_finite, 0u) << what;
          // 2e-6: float rounding.
          const double tolerance = 2e-6 + (tracked ? bound * e.standard_error() : 0);
          EXPECT_NEAR(e.mean(), expected, tolerance) << what;
        }
      }
}

/// Radiance of a glowing medium of length 1 that a camera sees from 1e5 away, where floats are 1/128 apart, at a step
/// that is a thousand times shorter than that; over what is right.
double seen_from_far_away(const std::string& integrator) {
  Node description = scene_for(integrator);
  Node& v = add_medium(description, "box", "linear");
  set(v, "albedo", "0,0,0");
  set(v, "emission_scale", "2");
  if (!tracks(integrator)) set(description, "render.step_size", "1e-5");
  const RayEstimate e =
      estimate(*committed(description), {{0, 0, -1e5f}, {0, 0, 1}}, tracks(integrator) ? 100000 / kFewer : 1);
  return e.mean() / (2 / kSigmaT * -std::expm1(-kSigmaT));
}

// G4 of the catalogue. The rounding of both faces moves 3 exp(-3) / (1 - exp(-3)) of 1/128; the rest is noise.
TEST(OracleInside, O11AMediumIsThereFromFarAway) {
  for (const IntegratorType& type : integrator_types())
    EXPECT_NEAR(seen_from_far_away(type.table.key), 1, 0.02 * std::sqrt(kFewer)) << type.table.key;
}

// The same for light that is scattered: a sun from behind the camera dims both ways.
TEST(OracleInside, O11SingleScatteringIsThatOfTheLengthInFrontOfTheCamera) {
  const double bound = sidak_z(1e-3, 7 * 2 * kPlaceCount);
  for (const IntegratorType& type : integrator_types())
    for (const char* shader : {"homogeneous", "linear"}) {
      Node description = scene_for(type.table.key);
      set(add_medium(description, "box", shader), "albedo", format_value(Numbers(3, kAlbedo)));
      Node& sun = add_light(description, "directional");
      set(sun, "direction", "0,0,1");
      set(sun, "irradiance", "1,1,1");
      const auto scene = committed(description);
      for (const float z : kPlaces) {
        const RayEstimate e = estimate(*scene, {{0.02f, 0.03f, z}, {0, 0, 1}}, 10000 / kFewer);
        const double from = std::clamp(double(z), -0.5, 0.5);
        const double expected =
            kAlbedo * kInv4PiD * std::exp(-kSigmaT * (from + 0.5)) * 0.5 * -std::expm1(-2 * kSigmaT * (0.5 - from));
        const std::string what = type.table.key + ", " + shader + ", camera at " + std::to_string(z);
        EXPECT_EQ(e.non_finite, 0u) << what;
        EXPECT_NEAR(e.mean(), expected, bound * e.standard_error() + 2e-6 * kInv4PiD)
            << what << ": " << z_score(e, expected);
      }
    }
}

struct Placed {
  const char* what;
  const char* position;
  float camera;  ///< z
};
constexpr Placed kLamps[] = {
    {"inside, beside the ray", "0.05,0.1,0.1", -1},    {"in the face", "0.05,0.1,-0.5", -1},
    {"in front of the medium", "0.05,0.1,-0.7", -1},   {"behind the medium, on the ray", "0,0,0.8", -1},
    {"behind the camera, on the ray", "0,0,-1.5", -1}, {"on the camera outside", "0,0,-1", -1},
    {"beside the camera inside", "0.05,0.1,0.1", 0.1f}};

/// A medium with a lamp that has a size or none.
Node lit(const std::string& integrator, const char* light, const char* position) {
  Node scene = scene_for(integrator);
  set(scene, "render.bounces", "2");
  set(add_medium(scene, "box", "linear"), "albedo", "0.9,0.9,0.9");
  Node& lamp = add_light(scene, light);
  if (std::string(light) == "quad") {
    set(lamp, "corner", position);
    set(lamp, "edge_u", "0.1,0,0");
    set(lamp, "edge_v", "0,0.1,0.02");
    set(lamp, "two_sided", "true");
  } else {
    set(lamp, std::string(light) == "point" ? "position" : "center", position);
  }
  if (std::string(light) == "sphere") set(lamp, "radius", "0.07");
  return scene;
}

TEST(OracleInside, O11LampsAnywhereGiveFiniteLight) {
  for (const IntegratorType& type : integrator_types())
    for (const char* light : {"point", "sphere", "quad"})
      for (const Placed& lamp : kLamps) {
        const auto scene = committed(lit(type.table.key, light, lamp.position));
        const RayEstimate e = estimate(*scene, {{0, 0, lamp.camera}, {0, 0, 1}}, 2000, 2);
        const std::string what = type.table.key + ", " + light + " " + lamp.what;
        EXPECT_EQ(e.non_finite, 0u) << what;
        EXPECT_TRUE(std::isfinite(e.mean()) && e.mean() > 0) << what << ": " << e.mean();
      }
}

// On the ray inside the medium, or on the camera there, the integral of 1/r^2 diverges: no value is right. Samples that
// are not finite are dropped and counted, and what is left is a number.
TEST(OracleInside, O11ALampOnTheRayOrOnTheCameraInsideTheMediumIsFiniteOrCounted) {
  for (const IntegratorType& type : integrator_types())
    for (const auto& [position, camera] : {std::pair("0,0,0.1", -1.0f), std::pair("0,0,0.1", 0.1f)}) {
      const auto scene = committed(lit(type.table.key, "point", position));
      const RayEstimate e = estimate(*scene, {{0, 0, camera}, {0, 0, 1}}, 20000, 2);
      const std::string what = type.table.key + ", camera at " + std::to_string(camera);
      std::printf("%-20s camera at %+.1f: %llu of 20000 samples not finite, mean of the others %.3g\n",
                  type.table.key.c_str(), double(camera), static_cast<unsigned long long>(e.non_finite), e.mean());
      EXPECT_TRUE(std::isfinite(e.mean()) && e.mean() > 0) << what << ": " << e.mean();
    }
}

// A camera that crosses the face sees the same picture on both sides. With the same random numbers nearly every sample
// changes by 1e-5 only; a few hit a lamp by chance on one side and just miss it on the other.
TEST(OracleInside, O11NothingJumpsWhenTheCameraCrossesTheFace) {
  for (const IntegratorType& type : integrator_types())
    for (const char* light : {"point", "sphere", "quad"}) {
      Node description = lit(type.table.key, light, "0.05,0.1,0.1");
      set(description, "render.bounces", "0");
      const auto scene = committed(description);
      const int samples = 20000 / kFewer;
      const auto at = [&](float z) { return estimate(*scene, {{0, 0, z}, {0, 0, 1}}, samples, 2).mean(); };
      for (const float face : {-0.5f, 0.5f}) {
        const double on = at(face), in_front = at(face - 1e-5f), behind = at(face + 1e-5f);
        const std::string what = type.table.key + ", " + light + ", face at " + std::to_string(face);
        if (face < 0) {
          EXPECT_NEAR(in_front / on, 1, 1e-3 * kFewer) << what;
          EXPECT_NEAR(behind / on, 1, 1e-3 * kFewer) << what;
        } else {
          EXPECT_LT(in_front, 1e-3) << what;  // a hundred-thousandth of a unit of medium is left
        }
      }
    }
}

}  // namespace
}  // namespace brume
