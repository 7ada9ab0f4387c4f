// O6 of the catalogue: extinctions of 1 to 4 to 16. A path that is led by one channel gives the others means that look
// converged and are wrong (D1), so every channel of every integrator is held against a closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/support/effort.h"
#include "tests/support/scenes.h"

namespace brume {
namespace {

constexpr double kInv4PiD = 0.07957747154594766788;
constexpr double kSigmaT[] = {0.25, 1, 4}, kAlbedo[] = {0.9, 0.6, 0.8}, kG = 0.3;

double henyey_greenstein(double cosine) {
  return kInv4PiD * (1 - kG * kG) / std::pow(1 + kG * kG - 2 * kG * cosine, 1.5);
}

/// A box of height 1 round the origin, crossed by rays up the z axis, that the sun shines on along the ray: from behind
/// the camera ("0,0,1") or against it. Its sides are 2 : 3 : 6 and the maps of ray_march_cached have 15 knots per ray,
/// so that two knots lie in its faces, and what is interpolated between them is linear, as the depth is.
Node slab(const std::string& integrator, const char* shader, const char* sun_direction) {
  Node scene = empty_scene();
  set(scene, "render.integrator", integrator);
  set(scene, "render.sampler", "independent");
  set(scene, "render.seed", std::to_string(integrator.size()));
  const ParamTable& settings = scene.child("render").table();
  if (settings.find("step_size")) set(scene, "render.step_size", "0.125");
  if (settings.find("shadow_map_resolution")) set(scene, "render.shadow_map_resolution", "15");
  Node& v = add_volume(scene, shader);
  const Numbers half{1.0 / 6, 0.25, 0.5};
  set(v, "bounds.min", format_value(Numbers{-half[0], -half[1], -half[2]}));
  set(v, "bounds.max", format_value(half));
  Numbers sigma_s, sigma_a;
  for (int c = 0; c < 3; ++c) {
    sigma_s.push_back(kSigmaT[c] * kAlbedo[c]);
    sigma_a.push_back(kSigmaT[c] * (1 - kAlbedo[c]));
  }
  set(v, "sigma_s", format_value(sigma_s));
  set(v, "sigma_a", format_value(sigma_a));
  set(v, "phase.type", "henyey_greenstein");
  set(v, "phase.g", format_value(kG));
  Node& sun = add_light(scene, "directional");
  set(sun, "direction", sun_direction);
  set(sun, "irradiance", "1,1,1");
  return scene;
}

/// Single scattering of a column of optical depth tau, whatever the density does along it: with the light from behind
/// the camera every point is dimmed twice alike, albedo p(-1) (1 - exp(-2 tau)) / 2; against it every path is equally
/// long, albedo p(1) tau exp(-tau).
double expected(bool from_behind, int channel, double column) {
  const double tau = kSigmaT[channel] * column;
  return kAlbedo[channel] * (from_behind ? henyey_greenstein(-1) * 0.5 * -std::expm1(-2 * tau)
                                         : henyey_greenstein(1) * tau * std::exp(-tau));
}

/// ray_march lights all its steps, and delta tracking one channel of three in the few samples that scatter.
int samples_for(const std::string& integrator) {
  return (integrator.starts_with("ray_march") ? 20000 : integrator.starts_with("delta") ? 600000 : 200000) / kFewer;
}

void expect_all_channels(const std::string& integrator, const char* shader, double column, int comparisons) {
  double largest = 0;
  for (const bool from_behind : {true, false}) {
    Node scene = slab(integrator, shader, from_behind ? "0,0,1" : "0,0,-1");
    if (std::string(shader) == "linear") set(scene, "volumes.0.gradient", "0.3,0.2,1.2");
    const RayEstimate e = estimate(*committed(scene), {{0.05f, -0.07f, -1}, {0, 0, 1}}, samples_for(integrator), 2);
    EXPECT_EQ(e.non_finite, 0u);
    for (int c = 0; c < 3; ++c) {
      const double right = expected(from_behind, c, column), noise = e.standard_error(c) / right;
      // Where every sample is the same, as along a backlit ray, only the rounding of floats is left: 2e-6.
      const double z = (e.mean(c) / right - 1) / std::hypot(noise, 1e-6);
      largest = std::max(largest, std::abs(z));
      EXPECT_LT(std::abs(z), sidak_z(1e-3, comparisons))
          << integrator << ", " << shader << ", channel " << c << ": " << e.mean(c) << " instead of " << right;
      // D1's wrong means had small errors, too, but of 30 %.
      EXPECT_LT(noise, 0.01 * std::sqrt(kFewer)) << integrator << ", " << shader << ", channel " << c;
    }
  }
  std::printf("%-20s %-11s largest |z| %.2f\n", integrator.c_str(), shader, largest);
}

TEST(OracleChromatic, O6EveryChannelOfEveryIntegratorIsRightInAHomogeneousSlab) {
  const auto& types = integrator_types();
  for (const IntegratorType& type : types)
    expect_all_channels(type.table.key, "homogeneous", 1, static_cast<int>(6 * types.size()));
}

// The same where the density rises along the ray: only for those that do not march, for a march is biased there. The
// column is that of 1 + 0.3 x + 0.2 y + 1.2 z at the ray's place.
TEST(OracleChromatic, O6EveryChannelOfEveryTrackerIsRightInARamp) {
  for (const char* integrator : {"delta_tracking", "delta_tracking_local", "null_scattering"})
    expect_all_channels(integrator, "linear", 1 + 0.3 * 0.05 - 0.2 * 0.07, 18);
}

// Orders of scattering up to the third: one path for three channels, three grey scenes of their coefficients.
TEST(OracleChromatic, O6EveryIntegratorGivesEachChannelWhatItsGreySceneHas) {
  const char* const integrators[] = {"decoupled", "stochastic_march", "delta_tracking", "delta_tracking_local",
                                     "null_scattering"};
  for (const char* integrator : integrators) {
    Node colourful = slab(integrator, "homogeneous", "1,1,1");
    set(colourful, "render.bounces", "2");
    Node& lamp = add_light(colourful, "point");
    set(lamp, "position", "0.3,0.2,-0.1");
    const Ray ray{{0.05f, -0.07f, -1}, {0, 0, 1}};
    const int samples = samples_for(integrator) / 4;
    const RayEstimate together = estimate(*committed(colourful), ray, samples, 2);
    for (int c = 0; c < 3; ++c) {
      Node grey = colourful;
      const std::string s = format_value(kSigmaT[c] * kAlbedo[c]), a = format_value(kSigmaT[c] * (1 - kAlbedo[c]));
      set(grey, "volumes.0.sigma_s", s + "," + s + "," + s);
      set(grey, "volumes.0.sigma_a", a + "," + a + "," + a);
      set(grey, "render.seed", std::to_string(100 + c));
      const auto scene = committed(grey);
      ASSERT_EQ(scene->needs.channels, 1);
      const RayEstimate alone = estimate(*scene, ray, samples, 2);
      EXPECT_LT(std::abs(z_score(together, alone, c)), sidak_z(1e-3, 15))
          << integrator << ", channel " << c << ": " << together.mean(c) << " and " << alone.mean(c);
      EXPECT_LT(together.standard_error(c), 0.03 * std::sqrt(kFewer) * together.mean(c)) << integrator << ' ' << c;
    }
  }
}

}  // namespace
}  // namespace brume
