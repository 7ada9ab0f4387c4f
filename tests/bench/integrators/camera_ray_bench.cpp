// Time of a whole camera ray of the smoke that ships, for each distance sampling and integrator.
#include <benchmark/benchmark.h>

#include "renderer/integrators/registry.h"
#include "tests/support/scenes.h"

namespace brume {
namespace {

void camera_rays(benchmark::State& state, const std::string& integrator, const std::string& distance_sampling) {
  Node description = shipped_scene("smoke");
  description = with_integrator(std::move(description), integrator);
  if (!distance_sampling.empty()) set(description, "render.distance_sampling", distance_sampling);
  set(description, "render.light_samples", "2");
  set(description, "render.bounces", std::to_string(state.range(0)));
  set(description, "camera.vfov_deg", "5");  // all pixels meet the smoke
  const auto scene = committed(description);
  const int threads = 1, width = 64, height = 48;
  WorkerPool pool(threads);
  Film film(width, height);
  for (auto _ : state) render_batch(*scene, 1, film, pool);
  using benchmark::Counter;
  state.counters["per_ray"] =
      Counter(static_cast<double>(state.iterations()) * width * height, Counter::kIsRate | Counter::kInvert);
}

#define BRUME_CAMERA_RAYS(name, ...)                \
  BENCHMARK_CAPTURE(camera_rays, name, __VA_ARGS__) \
      ->ArgName("bounces")                          \
      ->Arg(0)                                      \
      ->Arg(2)                                      \
      ->Unit(benchmark::kMillisecond)               \
      ->UseRealTime()
BRUME_CAMERA_RAYS(density, "decoupled", "density");
BRUME_CAMERA_RAYS(equi_angular, "decoupled", "equi_angular");
BRUME_CAMERA_RAYS(mis, "decoupled", "mis");
BRUME_CAMERA_RAYS(product, "decoupled", "product");
BRUME_CAMERA_RAYS(ray_march, "ray_march", "");
BRUME_CAMERA_RAYS(ray_march_cached, "ray_march_cached", "");
BRUME_CAMERA_RAYS(stochastic_march, "stochastic_march", "");
BRUME_CAMERA_RAYS(delta_tracking, "delta_tracking", "");
BRUME_CAMERA_RAYS(delta_tracking_local, "delta_tracking_local", "");
BRUME_CAMERA_RAYS(null_scattering, "null_scattering", "");
#undef BRUME_CAMERA_RAYS

}  // namespace
}  // namespace brume
