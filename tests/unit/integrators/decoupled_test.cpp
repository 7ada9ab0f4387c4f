// The integrator against closed forms, and against itself where the same light is described in two ways.
#include "renderer/integrators/decoupled.h"

#include <gtest/gtest.h>

#include "tests/support/scenes.h"

namespace brume {
namespace {

constexpr double kInv4PiD = 0.07957747154594766788;
const char* const kModes[] = {"density", "equi_angular", "mis", "product"};
/// Bound on |z| of one comparison in a test that makes `comparisons` of them.
double bound(int comparisons) { return sidak_z(1e-3, comparisons); }

Node independent_scene(int seed = 1) {
  Node scene = empty_scene();
  set(scene, "render.sampler", "independent");
  set(scene, "render.seed", std::to_string(seed));
  return scene;
}

void add_box(Node& scene, const std::string& low, const std::string& high, const std::string& sigma_s,
             const std::string& sigma_a, const std::string& shader = "homogeneous") {
  Node& v = add_volume(scene, shader);
  set(v, "bounds.min", low);
  set(v, "bounds.max", high);
  set(v, "sigma_s", sigma_s);
  set(v, "sigma_a", sigma_a);
}

void add_environment(Node& scene, const std::string& radiance) {
  set(add_light(scene, "environment"), "radiance", radiance);
}

void set_g(Node& scene, std::size_t volume, const std::string& g) {
  set(scene, "volumes." + std::to_string(volume) + ".phase.type", "henyey_greenstein");
  set(scene, "volumes." + std::to_string(volume) + ".phase.g", g);
}

Ray up_from(float z) { return {{0.1f, 0.2f, z}, {0, 0, 1}}; }

double henyey_greenstein(double g, double cosine) {
  return kInv4PiD * (1 - g * g) / std::pow(1 + g * g - 2 * g * cosine, 1.5);
}

// ---- Colour ---------------------------------------------------------------------------------------------------------

// O6 of the catalogue.
/// A slab lit along the line of sight: sigma_s p(-1) E integral of exp(-2 sigma t) = albedo p E (1 - exp(-2 tau)) / 2.
TEST(Decoupled, ExtinctionsOf1To4To16AreRightInEveryChannel) {
  for (const char* mode : kModes) {
    Node scene = independent_scene();
    set(scene, "render.distance_sampling", mode);
    add_box(scene, "-1,-1,0", "1,1,1", "0.9,3.6,14.4", "0.1,0.4,1.6");
    Node& sun = add_light(scene, "directional");
    set(sun, "direction", "0,0,1");
    set(sun, "irradiance", "2,2,2");
    const RayEstimate e = estimate(*committed(scene), up_from(-1), 100000);
    for (int c = 0; c < 3; ++c) {
      const double tau = std::pow(4.0, c), expected = 0.9 * kInv4PiD * 2 * 0.5 * -std::expm1(-2 * tau);
      EXPECT_LT(std::abs(z_score(e, expected, c)), bound(9))
          << mode << ", channel " << c << ": " << e.mean(c) << " instead of " << expected;
      EXPECT_LT(e.standard_error(c), 0.01 * expected);
    }
  }
}

// D1 of the catalogue on long paths: three channels carried by one path are three grey scenes.
TEST(Decoupled, EveryChannelOfAChromaticSceneIsTheGreySceneOfItsCoefficients) {
  const auto scene_of = [](const std::string& sigma_s, const std::string& sigma_a, const char* mode, int seed) {
    Node scene = independent_scene(seed);
    set(scene, "render.distance_sampling", mode);
    set(scene, "render.bounces", "4");
    add_box(scene, "-1,-1,0", "1,1,1", sigma_s, sigma_a);
    set_g(scene, 0, "0.5");
    set(add_light(scene, "point"), "position", "0.3,0.7,0.4");
    add_environment(scene, "0.5,0.5,0.5");
    return committed(scene);
  };
  const std::string scattering[] = {"0.3,0.3,0.3", "1.8,1.8,1.8", "4.6,4.6,4.6"},
                    absorption[] = {"0.1,0.1,0.1", "0.2,0.2,0.2", "0.4,0.4,0.4"};
  for (const char* mode : kModes) {
    const auto colourful = scene_of("0.3,1.8,4.6", "0.1,0.2,0.4", mode, 1);
    ASSERT_EQ(colourful->needs.channels, 3);
    const RayEstimate together = estimate(*colourful, up_from(-1), 40000, 2);
    for (int c = 0; c < 3; ++c) {
      const auto grey = scene_of(scattering[c], absorption[c], mode, 2 + c);
      ASSERT_EQ(grey->needs.channels, 1);
      const RayEstimate alone = estimate(*grey, up_from(-1), 40000, 2);
      EXPECT_LT(std::abs(z_score(together, alone, c)), bound(9))
          << mode << ", channel " << c << ": " << together.mean(c) << " and " << alone.mean(c);
      EXPECT_LT(together.standard_error(c), 0.05 * together.mean(c));
    }
  }
}

// D2 of the catalogue.
TEST(Decoupled, AChannelWithoutExtinctionSeesTheBackgroundAndItsOwnGlow) {
  for (const char* mode : kModes) {
    Node scene = independent_scene();
    set(scene, "render.distance_sampling", mode);
    set(scene, "render.bounces", "3");
    add_box(scene, "-1,-1,0", "1,1,2", "0,1,2", "0,1,0");
    set(scene, "volumes.0.emission_scale", "0.5");
    add_environment(scene, "1,1,1");
    set(add_light(scene, "point"), "position", "0.5,0.5,1");
    const RayEstimate e = estimate(*committed(scene), up_from(-1), 2000, 2);
    EXPECT_EQ(e.non_finite, 0u);
    EXPECT_NEAR(e.mean(0), 1 + 0.5 * 2, 2e-6) << mode;  // to rounding: nothing random is left
    EXPECT_LT(e.standard_error(0), 1e-9) << mode;
    EXPECT_GT(e.mean(2), 1) << mode;
  }
}

// ---- Furnaces -------------------------------------------------------------------------------------------------------

// A body that emits what it absorbs, in surroundings of its own temperature, cannot be seen: L = 1 solves
// dL/ds = -sigma_t L + sigma_s L + sigma_a. Emission, absorption, scattering and background all have to agree.
TEST(Decoupled, ABodyInThermalEquilibriumIsInvisible) {
  for (const char* shader : {"homogeneous", "gaussian", "sinusoid"}) {
    Node scene = independent_scene();
    set(scene, "render.bounces", "100000");
    add_box(scene, "-1,-1,0", "1,1,2", "0.5,1.5,3", "0.5,0.2,1", shader);
    set(scene, "volumes.0.emission_scale", "1");
    set(scene, "volumes.0.emission_color", "0.5,0.2,1");
    set_g(scene, 0, "0.6");
    add_environment(scene, "1,1,1");
    const RayEstimate e = estimate(*committed(scene), {{0.3f, -4, 0.7f}, normalize(Vec3(0.05f, 1, 0.1f))}, 30000);
    for (int c = 0; c < 3; ++c) {
      EXPECT_LT(std::abs(z_score(e, 1, c)), bound(9)) << shader << ", channel " << c << ": " << e.mean(c);
      EXPECT_LT(e.standard_error(c), 0.01);
    }
  }
}

// O2 of the catalogue.
TEST(Decoupled, WhiteFurnaceOfOverlappingMediaWithDifferentPhaseFunctionsGivesOne) {
  Node scene = independent_scene();
  set(scene, "render.bounces", "100000");
  add_box(scene, "-1,-1,0", "1,1,2", "1,2,0.5", "0,0,0");
  add_box(scene, "-0.5,-1,1", "2,1,3", "2,1,0", "0,0,0", "linear");  // denser upwards
  add_box(scene, "-1,-0.3,0.5", "1,2,1.5", "0,0,4", "0,0,0", "slabs");
  set_g(scene, 0, "0.8");
  set_g(scene, 1, "-0.4");
  add_environment(scene, "1,1,1");
  const RayEstimate e = estimate(*committed(scene), {{0.3f, -4, 0.7f}, normalize(Vec3(0.05f, 1, 0.1f))}, 40000);
  for (int c = 0; c < 3; ++c) {
    EXPECT_LT(std::abs(z_score(e, 1, c)), bound(3)) << "channel " << c << ": " << e.mean(c);
    EXPECT_LT(e.standard_error(c), 0.01);
  }
}

// ---- Overlap --------------------------------------------------------------------------------------------------------

TEST(Decoupled, TwoMediaOfHalfTheDensityAreOneOfTheWhole) {
  const auto scene_of = [](int count, const char* mode, const char* bounces, int seed) {
    Node scene = independent_scene(seed);
    set(scene, "render.distance_sampling", mode);
    set(scene, "render.bounces", bounces);
    for (int i = 0; i < count; ++i) {
      add_box(scene, "-1,-1,0", "1,1,2", "1.6,1.2,0.8", "0.4,0.8,0.2");
      set(scene, "volumes." + std::to_string(i) + ".density_scale", std::to_string(1.0 / count));
      set_g(scene, static_cast<std::size_t>(i), "0.7");
    }
    set(add_light(scene, "point"), "position", "0.4,-0.6,0.5");
    add_environment(scene, "0.3,0.3,0.3");
    return committed(scene);
  };
  for (const char* mode : kModes)
    for (const char* bounces : {"0", "2"}) {
      const RayEstimate one = estimate(*scene_of(1, mode, bounces, 1), up_from(-1), 30000, 2);
      const RayEstimate two = estimate(*scene_of(2, mode, bounces, 2), up_from(-1), 30000, 2);
      for (int c = 0; c < 3; ++c)
        EXPECT_LT(std::abs(z_score(one, two, c)), bound(18)) << mode << ", " << bounces << " bounces, channel " << c;
    }
}

// E5 of the catalogue: the phase functions of overlapping media are averaged by what each scatters, per channel.
TEST(Decoupled, PhaseFunctionsOfOverlappingMediaAreMixedByWhatEachScatters) {
  Node scene = independent_scene();
  add_box(scene, "-1,-1,0", "1,1,1", "0.3,1,0.5", "0.1,0,0.1");
  add_box(scene, "-1,-1,0", "1,1,1", "0.6,0,1.5", "0,0.2,0.4");
  set_g(scene, 0, "0.6");
  set_g(scene, 1, "-0.4");
  set(add_light(scene, "directional"), "direction", "0,0,1");
  set(scene, "lights.0.irradiance", "1,1,1");
  const RayEstimate e = estimate(*committed(scene), up_from(-1), 100000);
  const double s[2][3] = {{0.3, 1, 0.5}, {0.6, 0, 1.5}}, t[3] = {1.0, 1.2, 2.5};
  for (int c = 0; c < 3; ++c) {
    const double scattering = s[0][c] * henyey_greenstein(0.6, -1) + s[1][c] * henyey_greenstein(-0.4, -1);
    EXPECT_LT(std::abs(z_score(e, scattering / t[c] * 0.5 * -std::expm1(-2 * t[c]), c)), bound(3)) << "channel " << c;
    EXPECT_LT(e.relative_deviation(c), 3);
  }
}

TEST(Decoupled, OpticalDepthsOfPartlyOverlappingMediaAdd) {
  Node scene = empty_scene();
  add_box(scene, "-1,-1,0", "1,1,2", "0,0,0", "1,2,3");
  add_box(scene, "-1,-1,1", "1,1,3", "0,0,0", "0.5,0,4");
  add_box(scene, "-1,-1,5", "1,1,6", "0,0,0", "2,2,2");
  const auto s = committed(scene);
  Arena arena;
  RayStatistics statistics;
  RayDiagnostics met;
  const Sampler sampler(SamplerKind::Independent, 1, 0, 0);
  SampleContext context{*s, sampler, arena, statistics, &met};
  static_cast<void>(DecoupledIntegrator().radiance(up_from(-1), context));
  const double expected[] = {2 * 1 + 2 * 0.5 + 2, 2 * 2 + 2, 2 * 3 + 2 * 4 + 2};
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(met.optical_depth[c], expected[c], 1e-6 * expected[c]);
    EXPECT_NEAR(met.transmittance[c] / std::exp(-expected[c]), 1, 2e-6 * expected[c]);
  }
  EXPECT_EQ(met.segments, 5);
}

// ---- Cameras everywhere ---------------------------------------------------------------------------------------------

// G1 and O11 of the catalogue: in front, on the face, inside, on the far face and behind; continuous in between.
TEST(Decoupled, ACameraMayBeAnywhere) {
  for (const char* shape : {"box", "sphere"})
    for (const char* shader : {"homogeneous", "sinusoid"}) {
      Node scene = empty_scene();
      Node& v = add_volume(scene, shader);
      set(v, "bounds.type", shape);
      if (std::string(shader) == "sinusoid") set(v, "amplitude", "0");  // marched, but the same medium
      set(v, "sigma_s", "0,0,0");
      set(v, "sigma_a", "1.5,1.5,1.5");
      set(v, "emission_scale", "3");
      const auto s = committed(scene);
      for (const float z : {-5.0f, -1.5f, -1.0f, std::nextafter(-1.0f, 0.0f), -0.5f, 0.0f, 0.5f,
                            std::nextafter(1.0f, 0.0f), 1.0f, 1.5f, 5.0f}) {
        const RayEstimate e = estimate(*s, {{0, 0, z}, {0, 0, 1}}, 4);
        const double inside = std::clamp(1 - double(z), 0.0, 2.0), expected = 3 / 1.5 * -std::expm1(-1.5 * inside);
        EXPECT_EQ(e.non_finite, 0u);
        EXPECT_NEAR(e.mean(), expected, 3e-6) << shape << ", " << shader << ", camera at " << z;
      }
    }
}

// Where the ray meets the lamp inside the medium the integral of 1/r^2 diverges: no value is right, but none may be NaN
// without being noticed. Samples that fall on the lamp itself are not finite, and are counted by the caller.
TEST(Decoupled, LightInsideTheMediumOnTheCameraOrOnTheRayGivesRadianceThatIsFiniteOrCounted) {
  for (const char* mode : kModes)
    for (const char* position : {"0.1,0.2,0.5", "0.1,0.2,-1", "0.1,0.2,0", "0.1,0.2,1", "0,0,0.5"}) {
      Node scene = independent_scene();
      set(scene, "render.distance_sampling", mode);
      add_box(scene, "-1,-1,0", "1,1,1", "1,1,1", "0,0,0");
      set(add_light(scene, "point"), "position", position);
      const RayEstimate e = estimate(*committed(scene), up_from(-1), 20000);
      EXPECT_TRUE(std::isfinite(e.mean()) && e.mean() > 0) << mode << ", light at " << position;
      const bool met_inside = position[0] == '0' && position[2] == '1' && position[8] != '-';
      EXPECT_LT(e.non_finite, met_inside ? 14000u : 1u) << mode << ", light at " << position;
    }
}

// ---- Marching -------------------------------------------------------------------------------------------------------

TEST(Decoupled, HomogeneousMediaDoNotDependOnTheStep) {
  const auto with_step = [](const char* step) {
    Node scene = independent_scene();
    set(scene, "render.step_size", step);
    set(scene, "render.bounces", "3");
    add_box(scene, "-1,-1,0", "1,1,2", "1,2,3", "0.1,0.2,0.3");
    set(add_light(scene, "point"), "position", "0.4,-0.6,0.5");
    return estimate(*committed(scene), up_from(-1), 2000);
  };
  const RayEstimate a = with_step("0.01"), b = with_step("0.1"), c = with_step("10");
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(a.mean(k), b.mean(k));  // one exact segment whatever the step: the same bits
    EXPECT_EQ(a.mean(k), c.mean(k));
  }
}

TEST(Decoupled, AConstantDensityThatIsMarchedIsUnbiasedAtEveryStep) {
  for (const char* step : {"0.01", "0.3", "10"}) {
    Node scene = independent_scene();
    set(scene, "render.step_size", step);
    add_box(scene, "-1,-1,0", "1,1,1", "2,2,2", "1,1,1", "linear");
    set(scene, "volumes.0.gradient", "0,0,0");
    set(add_light(scene, "directional"), "direction", "0,0,1");
    set(scene, "lights.0.irradiance", "1,1,1");
    const RayEstimate e = estimate(*committed(scene), up_from(-1), 60000);
    EXPECT_LT(std::abs(z_score(e, 2.0 / 3 * kInv4PiD * 0.5 * -std::expm1(-6.0))), bound(3)) << "step " << step;
  }
}

// A stack of slabs whose edges are those of the segments, lit along the slabs: shadow rays stay within one slab, so the
// march is exact in expectation at a step as long as a slab is thick.
TEST(Decoupled, SlabsAlignedWithSegmentsAreUnbiasedAtAStepOfTheirThickness) {
  const double values[] = {1, 0, 2, 0, 0.5, 4, 0, 1};
  Node scene = independent_scene();
  set(scene, "render.step_size", "0.25");
  add_box(scene, "-1,-1,0", "1,1,2", "1,1,1", "0.5,0.5,0.5", "slabs");
  set(scene, "volumes.0.edges", "0,0.25,0.5,0.75,1,1.25,1.5,1.75,2");
  set(scene, "volumes.0.values", "1,0,2,0,0.5,4,0,1");
  set(add_light(scene, "directional"), "direction", "-1,0,0");  // from +x: the way to the face is 0.9
  set(scene, "lights.0.irradiance", "1,1,1");
  double expected = 0, transmittance = 1;
  for (const double v : values) {
    const double behind = transmittance * std::exp(-1.5 * v * 0.25);
    expected += 2.0 / 3 * kInv4PiD * (transmittance - behind) * std::exp(-1.5 * v * 0.9);
    transmittance = behind;
  }
  const RayEstimate e = estimate(*committed(scene), up_from(-1), 100000);
  EXPECT_LT(std::abs(z_score(e, expected)), bound(1)) << e.mean() << " instead of " << expected;
  EXPECT_LT(e.standard_error(), 0.005 * expected);
}

// ---- What the camera sees -------------------------------------------------------------------------------------------

TEST(Decoupled, VisibleLightsAreSeenThroughTheMediumInFrontOfThem) {
  Node scene = empty_scene();
  add_box(scene, "-1,-1,0", "1,1,2", "0,0,0", "1,1,1");
  Node& quad = add_light(scene, "quad");
  set(quad, "corner", "-1,-1,1.5");
  set(quad, "edge_u", "0,2,0");
  set(quad, "edge_v", "2,0,0");  // shines along -z, at the camera
  set(quad, "radiance", "3,2,1");
  const auto mean = [&](const char* visible) {
    set(scene, "lights.0.visible_to_camera", visible);
    return estimate(*committed(scene), up_from(-1), 1);
  };
  EXPECT_NEAR(mean("true").mean(0), 3 * std::exp(-1.5), 1e-5);  // lamps do not block, and only what is in front dims
  EXPECT_EQ(mean("false").mean(0), 0);
  add_environment(scene, "0.5,0.5,0.5");
  EXPECT_NEAR(mean("true").mean(2), std::exp(-1.5) + 0.5 * std::exp(-2.0), 1e-5);
}

TEST(Decoupled, AnEmptySceneShowsItsBackground) {
  Node scene = empty_scene();
  EXPECT_EQ(estimate(*committed(scene), up_from(-1), 1).mean(), 0);
  add_environment(scene, "0.25,0.5,1");
  EXPECT_EQ(estimate(*committed(scene), up_from(-1), 1).mean(2), 1);
}

TEST(Decoupled, RouletteDoesNotChangeTheMean) {
  const auto with_roulette = [](const char* on, int seed) {
    Node scene = independent_scene(seed);
    set(scene, "render.bounces", "40");
    set(scene, "render.russian_roulette", on);
    add_box(scene, "-1,-1,0", "1,1,2", "0.5,3,5", "0.5,0.2,2");
    set(add_light(scene, "point"), "position", "0.4,-0.6,3");
    return estimate(*committed(scene), up_from(-1), 40000, 2);
  };
  const RayEstimate on = with_roulette("true", 1), off = with_roulette("false", 2);
  EXPECT_LT(on.statistics.rays, off.statistics.rays);
  for (int c = 0; c < 3; ++c)
    EXPECT_LT(std::abs(z_score(on, off, c)), bound(3)) << on.mean(c) << " and " << off.mean(c);
}

}  // namespace
}  // namespace brume
