// Oracles of the catalogue of failures: pictures whose right value is known exactly. One test each, by its number;
// those about voxel grids are in oracle_geometry_test.cpp and oracle_data_test.cpp, the furnace in
// oracle_furnace_test.cpp.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/support/effort.h"
#include "tests/support/scenes.h"

namespace brume {
namespace {

constexpr double kInv4PiD = 0.07957747154594766788;

bool tracks(const std::string& integrator) {
  return integrator.starts_with("delta_tracking") || integrator == "null_scattering";
}

Node scene_for(const std::string& integrator) {
  Node scene = empty_scene();
  set(scene, "render.integrator", integrator);
  set(scene, "render.sampler", "independent");
  set(scene, "render.seed", std::to_string(integrator.size()));  // integrators that draw alike draw different paths
  return scene;
}

/// A box from z = 0 to 1, which a ray up the z axis crosses.
Node& add_slab(Node& scene, const std::string& shader, const std::string& sigma_s, const std::string& sigma_a) {
  Node& v = add_volume(scene, shader);
  set(v, "bounds.min", "-1,-1,0");
  set(v, "bounds.max", "1,1,1");
  set(v, "sigma_s", sigma_s);
  set(v, "sigma_a", sigma_a);
  return v;
}

void add_sun(Node& scene, const std::string& direction) {
  Node& sun = add_light(scene, "directional");
  set(sun, "direction", direction);
  set(sun, "irradiance", "1,1,1");
}

void add_white_background(Node& scene) { set(add_light(scene, "environment"), "radiance", "1,1,1"); }

const Ray kUp{{0.02f, 0.03f, -1}, {0, 0, 1}};

// O1: homogeneous box, no light but a white background. Marches are exact to float rounding; what tracking gives is
// right on average, and its only noise is that of transmittance itself.
TEST(Oracle, O1SlabTransmitsExpOfItsDepth) {
  constexpr int kTracked = 3 * 2 * 3;
  for (const IntegratorType& type : integrator_types())
    for (const char* shader : {"homogeneous", "linear"})
      for (const double depth : {0.01, 1.0, 4.0}) {
        Node scene = scene_for(type.table.key);
        Node& slab = add_slab(scene, shader, "0,0,0", "1,1,1");
        set(slab, "density_scale", format_value(depth));
        if (std::string(shader) == "linear") set(slab, "gradient", "0,0,0");  // level: marched, but the same medium
        add_white_background(scene);
        const std::string what = type.table.key + ", " + shader + ", depth " + std::to_string(depth);
        const bool tracked = tracks(type.table.key);
        const RayEstimate e = estimate(*committed(scene), kUp, tracked ? 100000 / kFewer : 16);
        EXPECT_EQ(e.non_finite, 0u) << what;
        if (tracked)
          EXPECT_LT(std::abs(z_score(e, std::exp(-depth))), sidak_z(1e-3, kTracked)) << what << ": " << e.mean();
        else
          EXPECT_NEAR(e.mean() / std::exp(-depth), 1, 1e-5) << what;
      }
}

// ---- O4 -------------------------------------------------------------------------------------------------------------

/// C1 of the catalogue: density 1, and `height` over a tenth of the path. Absorbs only, or scatters a sun that shines
/// along the ray.
Node spike(const std::string& integrator, double height, const char* sigma_s, const char* sigma_a) {
  Node scene = scene_for(integrator);
  Node& v = add_slab(scene, "slabs", sigma_s, sigma_a);
  set(v, "edges", "0,0.43,0.53,1");
  set(v, "values", format_value(Numbers{1, height, 1}));
  return scene;
}

// A majorant of 1.5 would make transmittance too bright by 16, 57 and 185 %. Whatever the density is, the sun's single
// scattering along the ray is albedo p E (1 - exp(-2 tau)) / 2.
TEST(Oracle, O4TrackersAreRightWithinOnePercentThroughASpike) {
  // With tight majorants a sample of transmittance is 0 or 1: a million of them know 0.12 to 0.27 %.
  const double bound = sidak_z(1e-3, 3 * 3 * 2), noise = std::sqrt(kFewer);
  for (const char* integrator : {"delta_tracking", "delta_tracking_local", "null_scattering"})
    for (const double height : {3.0, 6.0, 12.0}) {
      const std::string what = std::string(integrator) + ", spike of " + std::to_string(height);
      const double depth = 0.9 + 0.1 * height;
      Node absorbing = spike(integrator, height, "0,0,0", "1,1,1"),
           scattering = spike(integrator, height, "1,1,1", "0,0,0");
      add_white_background(absorbing);
      add_sun(scattering, "0,0,1");
      const RayEstimate seen = estimate(*committed(absorbing), kUp, 1000000 / kFewer);
      const RayEstimate lit = estimate(*committed(scattering), kUp, 100000 / kFewer);
      const double transmittance = std::exp(-depth), scattered = kInv4PiD * 0.5 * -std::expm1(-2 * depth);
      EXPECT_NEAR(seen.mean() / transmittance, 1, 0.01 * noise) << what;
      EXPECT_NEAR(lit.mean() / scattered, 1, 0.01 * noise) << what;
      EXPECT_LT(std::abs(z_score(seen, transmittance)), bound) << what << ": " << seen.mean();
      EXPECT_LT(std::abs(z_score(lit, scattered)), bound) << what << ": " << lit.mean();
      std::printf("spike %2.0f, %-20s transmittance %+.2f %%, single scattering %+.2f %%\n", height, integrator,
                  100 * (seen.mean() / transmittance - 1), 100 * (lit.mean() / scattered - 1));
    }
}

// Spikes of any width anywhere, also thinner than a cell and across its border, are below the majorant of every point.
TEST(Oracle, O4MajorantsBoundEverySpike) {
  for (const char* cells : {"1", "7", "32"})
    for (std::uint32_t i = 0; i < 40; ++i) {
      const Sampler random(SamplerKind::Independent, 4, i, 0);
      const double width = std::pow(10.0, -3 * double(random.u1(Decision::Pixel))) * 0.3;
      const double begin = 0.01 + (0.98 - width) * double(random.u1(Decision::Flight));
      Node description = scene_for("null_scattering");
      set(description, "render.majorant_cells", cells);
      Node& v = add_slab(description, "slabs", "0,0,0", "1,1,1");
      set(v, "edges", format_value(Numbers{0, begin, begin + width, 1}));
      set(v, "values", "1,12,1");
      const auto scene = committed(description);
      Arena arena;
      const ArenaScope scope(arena);
      const Ray ray{{-0.9f, -0.7f, -0.5f}, normalize(Vec3(0.7f, 0.6f, 1)), {0, 10}};
      bool met = false;
      for (const MajorantStretch& s : scene->majorants.along(ray, arena)) {
        // The spike's part of the stretch, in z.
        const double low = double(ray.at(s.span.begin).z), high = double(ray.at(s.span.end).z);
        if (high < begin || low > begin + width) continue;
        met = true;
        EXPECT_GE(s.majorant.r, 12) << cells << " cells, spike at " << begin << ", width " << width;
      }
      EXPECT_TRUE(met);
    }
}

// ---- O5 -------------------------------------------------------------------------------------------------------------

/// The field of B3, sigma(z) = k (0.05 + 8 sum exp(-((z - c) / 0.015)^2)), made of five soft balls in a thin fog.
Node blobs(const std::string& integrator, double k, int steps) {
  Node scene = scene_for(integrator);
  set(scene, "render.sampler", "sobol");
  set(scene, "render.step_size", format_value(1.0 / steps));
  add_slab(scene, "homogeneous", "0,0,0", "1,1,1");
  set(scene, "volumes.0.density_scale", format_value(0.05 * k));
  for (const double centre : {0.13, 0.31, 0.34, 0.62, 0.90}) {
    Node& ball = add_slab(scene, "gaussian", "0,0,0", "1,1,1");
    set(ball, "center", format_value(Numbers{double(kUp.origin.x), double(kUp.origin.y), centre}));
    set(ball, "sigma", format_value(0.015 / std::sqrt(2.0)));
    set(ball, "density_scale", format_value(8 * k));
  }
  add_white_background(scene);
  return scene;
}

/// Relative bias of the mean transmittance. 4096 Sobol' points put one offset into each of as many parts of a step.
double blob_bias(const std::string& integrator, double k, int steps) {
  const double depth = k * (0.05 + 8 * 5 * 0.015 * std::sqrt(3.14159265358979));  // the blobs lie well inside
  return estimate(*committed(blobs(integrator, k, steps)), kUp, 4096).mean() / std::exp(-depth) - 1;
}

// B3 of the catalogue, the columns "one offset". It gives two digits; its 0.00 means below 0.05 %. While the step is
// longer than a blob is wide (0.03), the bias falls about as its square; below, faster than any power.
TEST(Oracle, O5BlobsAreTooBrightByWhatTheCatalogueSays) {
  struct Row {
    double k;
    int steps;
    double bias, tolerance;
  };
  for (const char* integrator : {"decoupled", "ray_march", "stochastic_march"}) {
    for (const Row row : {Row{1, 16, 0.027, 0.0027}, Row{1, 32, 0.007, 0.0007}, Row{1, 64, 0, 5e-4},
                          Row{5, 32, 0.17, 0.017}, Row{5, 64, 0, 5e-4}, Row{5, 128, 0, 5e-4}}) {
      const double bias = blob_bias(integrator, row.k, row.steps);
      std::printf("blobs, %-16s k %.0f, %3d steps: bias %+.3f %%\n", integrator, row.k, row.steps, 100 * bias);
      EXPECT_NEAR(bias, row.bias, row.tolerance) << integrator << ", k " << row.k << ", " << row.steps << " steps";
    }
    const double order = std::log2(blob_bias(integrator, 1, 16) / blob_bias(integrator, 1, 32));
    EXPECT_NEAR(order, std::log2(0.027 / 0.007), 0.2) << integrator;
    EXPECT_GT(blob_bias(integrator, 5, 32) / std::abs(blob_bias(integrator, 5, 64)), 100) << integrator;
  }
}

// ---- O7 -------------------------------------------------------------------------------------------------------------

// A7 of the catalogue: a one-sided square of side 8 at height 0.1 over a ray of length 10 through a thin fog. Written
// out here: equi-angular about the middle of the square, and a point of the square drawn independently.
RunningMean about_the_centre(double side, double height, double sigma, int samples) {
  RunningMean mean;
  const double theta = std::atan(5 / height);
  for (int i = 0; i < samples; ++i) {
    const Sampler random(SamplerKind::Independent, 7, 0, static_cast<std::uint32_t>(i));
    const double s = height * std::tan((2 * double(random.u1(Decision::EquiangularDistance)) - 1) * theta);
    const double pdf = height / (2 * theta * (height * height + s * s));
    const Vec2 u = random.u2(Decision::LightPoint);
    const double x = (double(u.x) - 0.5) * side - s, z = (double(u.y) - 0.5) * side;
    const double r2 = x * x + z * z + height * height, cosine = height / std::sqrt(r2);
    mean.add(sigma * kInv4PiD * side * side * cosine / r2 / pdf);
  }
  return mean;
}

TEST(Oracle, O7PointFirstHasAtMostThreePercentOfTheVarianceAboutTheCentre) {
  constexpr double kSide = 8, kHeight = 0.1, kSigma = 1e-4;
  const int samples = 400000 / kFewer;
  Node scene = scene_for("decoupled");
  set(scene, "render.distance_sampling", "equi_angular");
  Node& fog = add_volume(scene, "homogeneous");
  set(fog, "bounds.min", "-5,-50,-50");
  set(fog, "bounds.max", "5,50,50");
  set(fog, "albedo", "1,1,1");
  set(fog, "density_scale", format_value(kSigma));
  Node& quad = add_light(scene, "quad");
  set(quad, "corner", format_value(Numbers{-kSide / 2, kHeight, -kSide / 2}));
  set(quad, "edge_u", format_value(Numbers{kSide, 0, 0}));
  set(quad, "edge_v", format_value(Numbers{0, 0, kSide}));  // x cross z = -y: down at the ray
  set(quad, "radiance", "1,1,1");
  const RayEstimate first = estimate(*committed(scene), {{-5, 0, 0}, {1, 0, 0}, {0, 10}}, samples);
  const RunningMean centre = about_the_centre(kSide, kHeight, kSigma, samples);
  const double ratio = first.channel[0].variance() / centre.variance();
  std::printf("relative deviation: point first %.2f, about the centre %.1f; variances %.2f %%\n",
              first.relative_deviation(), std::sqrt(centre.variance()) / centre.mean(), 100 * ratio);
  EXPECT_LT(ratio, 0.03);
  // Both are the same light, but for optical depths of 1e-3.
  const double z = (first.mean() - centre.mean()) / std::hypot(first.standard_error(), centre.standard_error());
  EXPECT_LT(std::abs(z), sidak_z(1e-3, 1)) << first.mean() << " and " << centre.mean();
}

// ---- O13 ------------------------------------------------------------------------------------------------------------

/// A voxel grid beside a coloured fog, all kinds of light.
std::shared_ptr<const Scene> everything(const std::string& integrator, const char* sampler) {
  Node scene = scene_for(integrator);
  set(scene, "render.sampler", sampler);
  set(scene, "render.bounces", "2");
  set(scene, "camera.position", "1,-5.5,1.9");
  set(scene, "camera.look_at", "1,0.9,1.6");
  Node& smoke = add_volume(scene, "vdb");
  set(smoke, "file", BRUME_SOURCE_DIR "/scenes/vdb/smoke_plume_96_f050.vdb");
  set(smoke, "density_scale", "8");
  if (scene.child("render").table().find("step_size")) set(scene, "render.step_size", "0.1");
  Node& fog = add_volume(scene, "homogeneous");
  set(fog, "albedo", "0.5,0.9,0.7");
  set(fog, "phase.type", "henyey_greenstein");
  for (const char* light : {"point", "quad", "sphere", "directional", "environment"}) add_light(scene, light);
  return committed(scene);
}

std::vector<Color> pixels_of(const Scene& scene, int threads) {
  WorkerPool pool(threads);
  Film film(21, 17);  // no multiples of a tile
  render_batch(scene, 2, film, pool);
  return film.mean_image().pixels;
}

TEST(Oracle, O13TheSameSeedGivesTheSameBitsOnAnyNumberOfThreads) {
  for (const IntegratorType& type : integrator_types())
    for (const char* sampler : {"sobol", "independent"}) {
      const auto scene = everything(type.table.key, sampler);
      const std::vector<Color> one = pixels_of(*scene, 1);
      float brightest = 0;
      for (const Color& c : one) brightest = std::max(brightest, max_channel(c));
      EXPECT_GT(brightest, 0) << type.table.key;
      for (const int threads : {4, 16})
        EXPECT_TRUE(pixels_of(*scene, threads) == one) << type.table.key << ", " << threads;
    }
}

}  // namespace
}  // namespace brume
