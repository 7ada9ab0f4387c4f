#include "renderer/experiments/pixel_probe.h"

#include <gtest/gtest.h>

#include "renderer/engine/engine.h"
#include "renderer/integrators/registry.h"
#include "tests/support/scenes.h"

namespace brume {
namespace {

constexpr PixelPlace kPlace{7, 5, 16, 12};

/// A marched volume that gets denser away from the camera, a lamp beside it.
Node scene_of(const char* integrator, const char* mode = nullptr) {
  Node scene = empty_scene();
  set(scene, "camera.position", "0,-4,0");
  set(scene, "camera.look_at", "0,0,0");
  set(scene, "render.integrator", integrator);
  if (mode) set(scene, "render.distance_sampling", mode);
  Node& v = add_volume(scene, "linear");
  set(v, "bounds.min", "-1,-1,-1");
  set(v, "bounds.max", "1,1,1");
  set(v, "gradient", "0,1,0");
  set(v, "offset", "1.2");
  set(v, "density_scale", "0.7");
  set(add_light(scene, "point"), "position", "1.5,-0.3,0.4");
  return scene;
}

PixelProbe probe(const Node& description, int samples = 16) {
  const auto scene = committed(description);
  return *probe_pixel(*scene, *make_integrator(*scene), {kPlace, samples});
}

TEST(PixelProbe, ItsRadianceAndVarianceAreThoseOfThePicturesPixel) {
  for (const char* integrator : {"decoupled", "ray_march", "delta_tracking"}) {
    const auto scene = committed(scene_of(integrator));
    Film film(kPlace.width, kPlace.height);
    WorkerPool pool(2);
    constexpr int kSamples = 9;
    render_batch(*scene, kSamples, film, pool);
    const PixelProbe p = *probe_pixel(*scene, *make_integrator(*scene), {kPlace, kSamples});
    EXPECT_EQ(p.samples, kSamples);
    EXPECT_EQ(p.radiance, film.mean(kPlace.x, kPlace.y)) << integrator;
    const Color of_mean = film.variance(kPlace.x, kPlace.y);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(p.variance[c] / kSamples / of_mean[c], 1, 1e-5) << integrator;
  }
}

TEST(PixelProbe, EveryDensityOfTheProfileIntegratesToOne) {
  Node description = scene_of("decoupled", "product");
  set(description, "render.step_size", "0.01");
  const RayProfile profile = probe(description).profile;
  ASSERT_EQ(profile.lights.size(), 1u);
  const auto integral = [&](const std::vector<double>& pdf) {
    EXPECT_EQ(pdf.size() + 1, profile.t.size());
    double sum = 0;
    for (std::size_t i = 0; i < pdf.size(); ++i) sum += pdf[i] * (profile.t[i + 1] - profile.t[i]);
    return sum;
  };
  EXPECT_NEAR(integral(profile.density_pdf), 1, 1e-4);
  EXPECT_NEAR(integral(profile.lights[0].product_pdf), 1, 1e-4);
  EXPECT_NEAR(integral(profile.lights[0].equiangular_pdf), 1, 1e-3);  // by midpoints
  // The ramp: 0.7 (1.2 + y), and what it lets through.
  EXPECT_NEAR(profile.sigma_t.front(), 0.7 * 0.2, 0.01);
  EXPECT_NEAR(profile.sigma_t.back(), 0.7 * 2.2, 0.02);
  EXPECT_NEAR(profile.transmittance.back(), std::exp(-0.7 * 2.4), 0.01);
}

TEST(PixelProbe, SharesTellWhichTechniqueHasDrawnTheLight) {
  const auto shares = [](const PixelProbe& p) {
    return std::array{p.density_share, p.equiangular_share, p.product_share};
  };
  EXPECT_EQ(shares(probe(scene_of("decoupled", "density"))), (std::array{1.0, 0.0, 0.0}));
  EXPECT_EQ(shares(probe(scene_of("decoupled", "equi_angular"))), (std::array{0.0, 1.0, 0.0}));
  EXPECT_EQ(shares(probe(scene_of("decoupled", "product"))), (std::array{0.0, 0.0, 1.0}));
  EXPECT_EQ(shares(probe(scene_of("ray_march"))), (std::array{0.0, 0.0, 0.0}));
  for (const Node& combined : {scene_of("decoupled", "mis"), scene_of("null_scattering")}) {
    const PixelProbe p = probe(combined, 64);
    EXPECT_GT(p.density_share, 0.02);
    EXPECT_GT(p.equiangular_share, 0.02);
    EXPECT_NEAR(p.density_share + p.equiangular_share, 1, 1e-12);
  }
}

TEST(PixelProbe, MisFavoursAnglesNextToALampAndTheDensityInThickSmoke) {
  const auto angles = [](const char* position, const char* scale) {
    Node description = scene_of("decoupled", "mis");
    set(description, "lights.0.position", position);
    set(description, "volumes.0.density_scale", scale);
    return probe(description, 256).equiangular_share;
  };
  EXPECT_GT(angles("-0.1,0,0.08", "0.05"), 0.75);
  EXPECT_LT(angles("3,-3,0", "30"), 0.25);
}

TEST(PixelProbe, LightSamplesLieInTheMedium) {
  for (const char* integrator : {"decoupled", "ray_march", "stochastic_march", "delta_tracking", "null_scattering"}) {
    const PixelProbe p = probe(scene_of(integrator));
    EXPECT_FALSE(p.light_samples.empty()) << integrator;
    for (const PixelProbe::LightSample& s : p.light_samples) {
      EXPECT_GT(s.t, p.profile.t.front() - 0.05) << integrator;  // of rays beside the pixel's middle
      EXPECT_LT(s.t, p.profile.t.back() + 0.05) << integrator;
      EXPECT_GT(s.carried, 0) << integrator;
    }
  }
}

TEST(PixelProbe, AChartShowsEachDensityUpToItsMaximum) {
  const auto scene = committed(scene_of("decoupled", "mis"));
  const PixelProbe p = *probe_pixel(*scene, *make_integrator(*scene), {kPlace, 16});
  const Chart chart = chart_of(p, *scene);
  ASSERT_EQ(chart.series.size(), 6u);  // extinction, transmittance, two densities, samples of both
  for (const Series& series : chart.series) {
    double most = 0;
    for (const auto& point : series.points) most = std::max(most, point[1]);
    EXPECT_LE(most, 1) << series.name;
    EXPECT_GT(most, 0.2) << series.name;
  }
}

TEST(PixelProbe, ARayThatMeetsNothingSaysSo) {
  Node description = scene_of("decoupled");
  set(description, "camera.look_at", "0,-8,0");
  const auto scene = committed(description);
  const PixelProbe p = *probe_pixel(*scene, *make_integrator(*scene), {kPlace, 4});
  EXPECT_TRUE(p.profile.t.empty());
  EXPECT_EQ(p.transmittance, Color(1));
  EXPECT_EQ(p.optical_depth, Color(0));
  EXPECT_TRUE(chart_of(p, *scene).series.empty());
}

TEST(PixelProbe, StopsWhenItIsNotWantedAnyMore) {
  const auto scene = committed(scene_of("decoupled"));
  std::stop_source stop;
  stop.request_stop();
  EXPECT_FALSE(probe_pixel(*scene, *make_integrator(*scene), {kPlace, 1 << 20}, stop.get_token()));
}

}  // namespace
}  // namespace brume
