// Surfaces among the media: closed forms, the furnace, and the same light described in two ways.
#include <gtest/gtest.h>

#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

namespace brume {
namespace {

constexpr double kPiD = 3.14159265358979323846;

std::vector<std::string> all_integrators() {
  std::vector<std::string> keys;
  for (const IntegratorType& type : integrator_types()) keys.push_back(type.table.key);
  return keys;
}

Node independent_scene(int seed = 1) {
  Node scene = empty_scene();
  set(scene, "render.sampler", "independent");
  set(scene, "render.seed", std::to_string(seed));
  return scene;
}

Node& add_floor(Node& scene, const std::string& albedo) {
  Node& floor = add_surface(scene, "plane");
  set(floor, "material.albedo", albedo);
  return floor;
}

Node& add_box(Node& scene, const std::string& low, const std::string& high, const std::string& sigma_s,
              const std::string& sigma_a) {
  Node& v = add_volume(scene, "homogeneous");
  set(v, "bounds.min", low);
  set(v, "bounds.max", high);
  set(v, "sigma_s", sigma_s);
  set(v, "sigma_a", sigma_a);
  return v;
}

/// Bound on |z| in a test of this file that makes `n` comparisons.
double bound(int n) { return sidak_z(1e-3, n); }

/// A camera above looks straight down through an absorbing slab, between z = 0.5 and 1, at a floor that a lamp at the
/// height 2 lights from the side: L = albedo / pi * I cos / d^2 * exp(-tau seen) * exp(-tau lit).
TEST(Surfaces, AFloorReflectsByLambertsLawThroughTheMedium) {
  const Ray down{{0, 0, 4}, {0, 0, -1}};
  for (const std::string& key : all_integrators()) {
    Node scene = independent_scene();
    add_floor(scene, "0.8,0.5,0.2");
    Node& lamp = add_light(scene, "point");
    set(lamp, "position", "1.5,0,2");
    set(lamp, "intensity", "7,8,9");
    add_box(scene, "-5,-5,0.5", "5,5,1", "0,0,0", "0.6,0.8,1");
    set(scene, "render.bounces", "0");
    const RayEstimate e = estimate(*committed(with_integrator(scene, key)), down, 20000);
    const double d = 2.5, cosine = 2 / d, albedo[] = {0.8, 0.5, 0.2}, intensity[] = {7, 8, 9}, sigma[] = {0.6, 0.8, 1};
    for (int c = 0; c < 3; ++c) {
      const double expected =
          albedo[c] / kPiD * intensity[c] * cosine / (d * d) * std::exp(-sigma[c] * 0.5 * (1 + 1 / cosine));
      // Marching knows the transmittance; a deep shadow map interpolates it.
      EXPECT_NEAR(e.mean(c), expected, expected * (key == "ray_march_cached" ? 1e-2 : 1e-5) + 5 * e.standard_error(c))
          << key << ' ' << c;
    }
  }
}

/// The integrating sphere: a lamp in the middle lights the wall evenly, and so does the wall itself. Every bounce adds
/// the last one's light times the albedo.
TEST(Surfaces, EveryBounceInAnIntegratingSphereAddsAPowerOfTheAlbedo) {
  for (const std::string& key : all_integrators())
    for (const int bounces : {0, 1, 3}) {
      Node scene = independent_scene();
      Node& wall = add_surface(scene, "sphere");
      set(wall, "radius", "2");
      set(wall, "material.albedo", "0.5,0.5,0.5");
      set(add_light(scene, "point"), "position", "0,0,0");
      set(scene, "lights.0.intensity", "3,3,3");
      set(scene, "render.bounces", std::to_string(bounces));
      set(scene, "render.russian_roulette", "false");
      double expected = 0;
      for (int b = 0; b <= bounces; ++b) expected += std::pow(0.5, b + 1) * 3 / (2 * 2) / kPiD;
      const RayEstimate e = estimate(*committed(with_integrator(scene, key)), {{0.5f, -0.3f, 0}, {0.6f, 0, -0.8f}}, 50);
      EXPECT_NEAR(e.mean(), expected, 1e-5 * expected) << key << " after " << bounces << " bounces";
      EXPECT_LT(e.relative_deviation(), 1e-4) << key;
    }
}

TEST(Surfaces, AFloorKeepsTheSunAway) {
  for (const std::string& key : all_integrators()) {
    Node scene = independent_scene();
    add_floor(scene, "0.5,0.5,0.5");
    set(add_floor(scene, "0.5,0.5,0.5"), "point", "0,0,1");
    Node& sun = add_light(scene, "directional");
    set(sun, "direction", "0,0,-1");
    set(sun, "irradiance", "2,2,2");
    const Ray down{{0, 0, 0.5f}, {0.6f, 0, -0.8f}};
    EXPECT_EQ(estimate(*committed(with_integrator(scene, key)), down, 100).mean(), 0) << key;
    set(scene, "surfaces.1.enabled", "false");
    EXPECT_NEAR(estimate(*committed(with_integrator(scene, key)), down, 100).mean(), 0.5 * 2 / kPiD, 1e-6) << key;
  }
}

/// Everything scatters or reflects all, and the surroundings are 1 everywhere: so is every picture.
TEST(Surfaces, WhiteFurnaceGivesOneWithABallInTheMedium) {
  const auto keys = all_integrators();
  const double z = bound(static_cast<int>(keys.size()));
  for (const std::string& key : keys) {
    if (key == "ray_march_cached") continue;  // caches no environment: the same as ray_march
    Node scene = independent_scene();
    set(scene, "render.bounces", "1000");
    set(add_light(scene, "environment"), "radiance", "1,1,1");
    Node& ball = add_surface(scene, "sphere");
    set(ball, "radius", "0.6");
    set(ball, "material.albedo", "1,1,1");
    Node& cube = add_surface(scene, "mesh");
    set(cube, "file", write_obj("furnace.obj", cube_mesh(0.3f)));
    set(cube, "transform.translate", "0.7,0.2,0.4");
    set(cube, "transform.rotate_deg", "20,30,40");
    set(cube, "material.albedo", "1,1,1");
    Node& fog = add_box(scene, "-1,-1,-1", "1,1,1", "1.5,1.5,1.5", "0,0,0");
    set(fog, "phase.type", "henyey_greenstein");
    set(fog, "phase.g", "0.6");
    RunningMean mean;
    const auto s = committed(with_integrator(scene, key));
    for (const Vec3 target : {Vec3{0, 0, 0}, Vec3{0.7f, 0.2f, 0.4f}, Vec3{-0.7f, 0.1f, -0.7f}}) {
      const Vec3 from{0.3f, -3, 0.5f};
      const RayEstimate e = estimate(*s, {from, normalize(target - from)}, key == "ray_march" ? 1500 : 12000);
      EXPECT_LT(std::abs(z_score(e, 1)), z) << key << ": " << e.mean() << " +- " << e.standard_error();
      EXPECT_LT(e.standard_error(), 0.03) << key;
      EXPECT_EQ(e.non_finite, 0u);
    }
  }
}

/// A ray of sunlight along z with a ball in its way: the medium behind the ball is dark, beside it lit.
TEST(Surfaces, ABallCastsItsShadowIntoTheMedium) {
  const auto radiance = [&](const std::string& key, float z, bool with_ball) {
    Node scene = independent_scene();
    set(scene, "render.bounces", "0");
    add_box(scene, "-2,-2,-2", "2,2,2", "0.2,0.2,0.2", "0,0,0");
    set(add_light(scene, "directional"), "direction", "0,0,-1");
    Node& ball = add_surface(scene, "sphere");
    set(ball, "radius", "0.5");
    set(ball, "enabled", with_ball ? "true" : "false");
    // Between x = -0.4 and 0.4, where all is in the shadow at z = -1.
    return estimate(*committed(with_integrator(scene, key)), {{-0.4f, 0, z}, {1, 0, 0}, {0, 0.8f}}, 300).mean();
  };
  for (const std::string& key : all_integrators()) {
    EXPECT_EQ(radiance(key, -1, true), 0) << key;
    EXPECT_GT(radiance(key, -1, false), 0) << key;
    EXPECT_GT(radiance(key, 1, true), 0) << key << ": before the ball, not behind it";
  }
}

/// A glowing ball is the same light whether it is a lamp or a surface, seen by the medium and by the camera.
TEST(Surfaces, AGlowingSphereAndMeshLightAsTheLampsOfTheSameShape) {
  const std::string cube = write_obj("glow.obj", cube_mesh(0.25f));
  const double z = bound(2 * 2 * 7 * 2);
  for (const char* shape : {"sphere", "mesh"})
    for (const std::string& key : all_integrators()) {
      RayEstimate results[2][2];
      for (const bool as_surface : {false, true}) {
        Node scene = independent_scene(as_surface ? 1 : 2);
        set(scene, "render.bounces", "0");
        add_box(scene, "-1,-1,-1", "1,1,1", "0.5,0.5,0.5", "0.1,0.1,0.1");
        Node& thing = as_surface ? add_surface(scene, shape) : add_light(scene, shape);
        if (std::string(shape) == "sphere") {
          set(thing, "center", "0,1.6,0.3");
          set(thing, "radius", "0.3");
        } else {
          set(thing, "file", cube);
          set(thing, "transform.translate", "0,1.6,0.3");
          set(thing, "transform.scale", "1,0.7,1.3");
          set(thing, "transform.rotate_deg", "10,20,30");
        }
        if (as_surface) set(thing, "material.type", "emissive");
        set(thing, as_surface ? "material.radiance" : "radiance", "5,5,5");
        if (!as_surface) set(thing, "visible_to_camera", "true");
        const auto s = committed(with_integrator(scene, key));
        const int samples = key.starts_with("ray_march") ? 1000 : 20000;
        results[as_surface][0] = estimate(*s, {{-3, 0.2f, 0.1f}, {1, 0, 0}}, samples);
        results[as_surface][1] = estimate(*s, {{0, -3, 0.3f}, {0, 1, 0}}, samples);
      }
      for (int ray = 0; ray < 2; ++ray) {
        EXPECT_LT(std::abs(z_score(results[0][ray], results[1][ray])), z)
            << shape << ' ' << key << " ray " << ray << ": " << results[0][ray].mean() << " and "
            << results[1][ray].mean();
        EXPECT_LT(results[0][ray].standard_error(), 0.03 * results[0][ray].mean()) << shape << ' ' << key;
      }
    }
}

/// The picture behind a holdout is black, the medium in front of it is not.
TEST(Surfaces, AHoldoutHidesWhatIsBehind) {
  for (const std::string& key : all_integrators()) {
    Node scene = independent_scene();
    set(add_light(scene, "environment"), "radiance", "1,1,1");
    add_box(scene, "-1,-1,-1", "1,1,1", "0,0,0", "0.5,0.5,0.5");
    Node& plate = add_surface(scene, "plane");
    set(plate, "material.type", "holdout");
    const Ray down{{0, 0, 4}, {0, 0, -1}};
    EXPECT_EQ(estimate(*committed(with_integrator(scene, key)), down, 50).mean(), 0) << key;
    set(scene, "volumes.0.emission_scale", "2");
    const RayEstimate e = estimate(*committed(with_integrator(scene, key)), down, 5000);
    const double expected = 2 * -std::expm1(-0.5) / 0.5;
    EXPECT_NEAR(e.mean(), expected, 1e-5 + 5 * e.standard_error()) << key;
  }
}

/// The medium inside a mesh is the medium inside the box of the same size, whatever the transform.
TEST(Surfaces, AMeshBoundsAMedium) {
  const auto transmitted = [](bool mesh, const Ray& ray) {
    Node scene = independent_scene();
    set(add_light(scene, "environment"), "radiance", "1,1,1");
    Node& v = add_volume(scene, "homogeneous");
    set(v, "sigma_s", "0,0,0");
    set(v, "sigma_a", "0.7,0.7,0.7");
    if (mesh) {
      set(v, "bounds.type", "mesh");
      set(v, "bounds.file", write_obj("bounds.obj", cube_mesh()));
    }
    set(v, "transform.scale", "1,-0.5,2");
    set(v, "transform.rotate_deg", "10,50,80");
    set(v, "transform.translate", "0.2,0.1,0");
    return estimate(*committed(scene), ray, 1).mean();
  };
  for (int i = 0; i < 20; ++i) {
    const Vec3 from{-4, 0.3f * static_cast<float>(i) - 3, 1}, to{0.3f, 0.1f, 0.05f * static_cast<float>(i)};
    const Ray ray{from, normalize(to - from)};
    EXPECT_NEAR(transmitted(true, ray), transmitted(false, ray), 2e-6) << i;
    const Ray inside{{0.2f, 0.1f, 0}, normalize(from)};
    EXPECT_NEAR(transmitted(true, inside), transmitted(false, inside), 2e-6) << i;
  }
}

TEST(Surfaces, WithoutThemEmbreeIsNotStarted) {
  Node scene = independent_scene();
  EXPECT_EQ(committed(scene)->surfaces, nullptr);
  EXPECT_FALSE(committed(scene)->needs.surfaces);
  Node& ball = add_surface(scene, "sphere");
  EXPECT_TRUE(committed(scene)->needs.surfaces);
  EXPECT_EQ(committed(scene)->needs.channels, 1) << "a grey surface needs one channel";
  set(ball, "material.albedo", "0.1,0.2,0.3");
  EXPECT_EQ(committed(scene)->needs.channels, 3);
  set(ball, "enabled", "false");
  EXPECT_EQ(committed(scene)->surfaces, nullptr);
}

}  // namespace
}  // namespace brume
