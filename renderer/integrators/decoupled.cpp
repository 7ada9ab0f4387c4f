#include "renderer/integrators/decoupled.h"

#include "renderer/integrators/direct_light.h"
#include "renderer/integrators/marched_path.h"
#include "renderer/integrators/path.h"
#include "renderer/integrators/registry.h"
#include "renderer/march/distribute.h"

namespace brume {
namespace {

/// One path. A path is a loop and not a recursion: nothing of a ray's record is needed once its scattered ray is known,
/// so the arena is rewound at every bounce and the pool does not grow with their number.
template <int C> Color trace(Ray ray, SampleContext& context) {
  const Scene& scene = context.scene;
  const Sampler& sampler = context.sampler;
  Color radiance;
  Color beta(1);
  for (int bounce = 0;; ++bounce) {
    const ArenaScope scope(context.arena);
    ++context.statistics.rays;

    const std::optional<SurfaceHit> surface = close(ray, scene);

    // record
    const MarchSettings settings{scene.step_size, sampler.u1(Decision::MarchOffset, bounce), scene.render.time,
                                 scene.needs.product};
    MarchRecord<C> rec = record_ray<C>(ray, settings, context);
    // distribute
    if (!rec.empty()) distribute(rec, beta, context.arena);
    if (bounce == 0) {
      if (context.diagnostics) diagnose(rec, *context.diagnostics);
      // Scattered rays add no light that they meet: the light samples at every bounce have counted it all.
      radiance = visible_lights(scene, ray, surface, [&](float t) { return to_color(transmittance_to(rec, t)); });
    }

    if (rec.empty() && !surface) return radiance;

    // estimate
    const int light_samples = bounce == 0 || scene.render.light_samples ? context.light_samples() : 1;
    MarchedShadows<C> shadows(bounce, context);
    if (!rec.empty()) {
      radiance += beta * emitted_radiance(rec);
      if (rec.scattered() > 0) direct_light(rec, ray, beta, bounce, light_samples, context, shadows);
    }
    if (surface)
      light_at_surface<C>(*surface, beta * to_color(transmittance(rec)), bounce, 1, light_samples, context, shadows);
    radiance += shadows.light();

    // bounce
    if (bounce == scene.render.bounces) return radiance;
    if (!scatter(rec, surface, ray, beta, bounce, context)) return radiance;
  }
}

}  // namespace

Color DecoupledIntegrator::radiance(const Ray& camera_ray, SampleContext& context) const {
  return context.scene.needs.channels == 1 ? trace<1>(camera_ray, context) : trace<3>(camera_ray, context);
}

IntegratorType decoupled_integrator_type() {
  return {
      integrator_table("decoupled", "Decoupled ray-marching",
                       "Marches each ray once, then draws light samples from what it recorded (Kulla 2011).",
                       {sampling_params(), balanced_light_params(), march_params(), path_params(), random_params()}),
      make_as<DecoupledIntegrator>};
}

}  // namespace brume
