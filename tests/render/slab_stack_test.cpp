// "Unbiased where segments are homogeneous" (renderer/march/march_record.h), taken at its word: a stack of homogeneous
// slabs, marched with segments that are the slabs.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/support/effort.h"
#include "tests/support/scenes.h"

namespace brume {
namespace {

constexpr double kInv4PiD = 0.07957747154594766788;
constexpr double kThickness = 0.25, kSigmaS = 1, kSigmaA = 0.5, kSigmaT = kSigmaS + kSigmaA;
constexpr double kDensity[] = {1, 0, 2, 0.1, 0.5, 4, 0, 1};
constexpr int kSlabs = static_cast<int>(std::size(kDensity));
const char* const kModes[] = {"density", "equi_angular", "mis", "product"};
const Ray kUp{{0.1f, 0.2f, -1}, {0, 0, 1}};

/// Eight slabs from z = 0 to 2. A shadow ray begins anywhere inside a slab, so its steps cannot be aligned; they are so
/// short (a 250th of a slab) that their bias, (shadow step x jump of sigma_t)^2 / 24 per face, is below 1e-5.
Node stack(const char* mode) {
  Node scene = empty_scene();
  set(scene, "render.sampler", "independent");
  set(scene, "render.distance_sampling", mode);
  set(scene, "render.step_size", format_value(kThickness));
  set(scene, "render.shadow_step_size", "0.001");
  Node& v = add_volume(scene, "slabs");
  set(v, "bounds.min", "-1,-1,0");
  set(v, "bounds.max", "1,1,2");
  Numbers edges, values(std::begin(kDensity), std::end(kDensity));
  for (int i = 0; i <= kSlabs; ++i) edges.push_back(i * kThickness);
  set(v, "edges", format_value(edges));
  set(v, "values", format_value(values));
  set(v, "sigma_s", format_value(Numbers(3, kSigmaS)));
  set(v, "sigma_a", format_value(Numbers(3, kSigmaA)));
  return scene;
}

/// Optical depth from the face z = 0 up to z.
double depth_below(double z) {
  double column = 0;
  for (int i = 0; i < kSlabs; ++i) column += kDensity[i] * std::clamp(z - i * kThickness, 0.0, kThickness);
  return kSigmaT * column;
}

/// Single scattering along the ray: the integral of sigma_s exp(-depth) times what arrives at z, slab by slab.
double quadrature(const std::function<double(double)>& arriving) {
  double sum = 0;
  for (int i = 0; i < kSlabs; ++i)
    sum +=
        integrate([&](double z) { return kSigmaS * kDensity[i] * kInv4PiD * std::exp(-depth_below(z)) * arriving(z); },
                  i * kThickness, (i + 1) * kThickness, 100);
  return sum;
}

TEST(SlabStack, TransmittanceIsExactInEverySample) {
  Node scene = stack("mis");
  set(scene, "volumes.0.sigma_s", "0,0,0");
  set(scene, "volumes.0.sigma_a", format_value(Numbers(3, kSigmaT)));
  set(add_light(scene, "environment"), "radiance", "1,1,1");
  const RayEstimate e = estimate(*committed(scene), kUp, 10000);
  EXPECT_NEAR(e.mean() / std::exp(-depth_below(2)), 1, 2e-6);
  EXPECT_LT(e.relative_deviation(), 1e-6);
}

/// What is measured by all modes against the quadrature.
void expect_unbiased(const char* what, double expected, const std::function<void(Node&)>& add_the_light) {
  int seed = 0;
  for (const char* mode : kModes) {
    Node scene = stack(mode);
    set(scene, "render.seed", std::to_string(++seed));  // of a sun the modes are all the same
    add_the_light(scene);
    const RayEstimate e =
        estimate(*committed(scene), kUp, (full_effort() ? 2000000 : 80000) / kFewer, 2);  // pairs: MIS takes turns
    std::printf("%-22s %-12s %+.3f %% +- %.3f %%\n", what, mode, 100 * (e.mean() / expected - 1),
                100 * e.standard_error() / expected);
    EXPECT_LT(std::abs(z_score(e, expected)), sidak_z(1e-3, 12)) << what << ", " << mode << ": " << e.mean();
    EXPECT_LT(e.standard_error(), 0.005 * std::sqrt(kFewer) * expected) << what << ", " << mode;
  }
}

std::function<void(Node&)> sun(const char* direction) {
  return [direction](Node& scene) {
    Node& light = add_light(scene, "directional");
    set(light, "direction", direction);
    set(light, "irradiance", "1,1,1");
  };
}

TEST(SlabStack, SunAlongTheAxisIsUnbiasedAtAStepOfOneSlab) {
  const double whole = depth_below(2);
  const double behind = quadrature([](double z) { return std::exp(-depth_below(z)); });
  const double against = quadrature([&](double z) { return std::exp(depth_below(z) - whole); });
  // Both have closed forms, for the quadrature's sake.
  EXPECT_NEAR(behind, kSigmaS / kSigmaT * kInv4PiD * 0.5 * -std::expm1(-2 * whole), 1e-12);
  EXPECT_NEAR(against, kSigmaS / kSigmaT * kInv4PiD * whole * std::exp(-whole), 1e-12);
  expect_unbiased("sun behind the camera", behind, sun("0,0,1"));
  expect_unbiased("sun against the camera", against, sun("0,0,-1"));
}

TEST(SlabStack, LampBesideTheStackIsUnbiasedAtAStepOfOneSlabInAllModes) {
  // Beside the box: a shadow ray from z leaves through the side x = 1, or through the top.
  constexpr double kX = 1.6, kZ = 2.5;
  const double x0 = double(kUp.origin.x), y0 = double(kUp.origin.y);
  const double expected = quadrature([&](double z) {
    const double dx = kX - x0, dz = kZ - z, distance = std::hypot(dx, dz);
    const double inside = std::min((1 - x0) / dx, dz > 0 ? (2 - z) / dz : 1);
    const double depth = (depth_below(z + inside * dz) - depth_below(z)) * distance / dz;
    return std::exp(-depth) / (distance * distance);
  });
  expect_unbiased("lamp beside the stack", expected, [&](Node& scene) {
    Node& lamp = add_light(scene, "point");
    set(lamp, "position", format_value(Numbers{kX, y0, kZ}));
    set(lamp, "intensity", "1,1,1");
  });
}

}  // namespace
}  // namespace brume
