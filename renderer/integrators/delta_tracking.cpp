#include "renderer/integrators/delta_tracking.h"

#include "renderer/integrators/path.h"
#include "renderer/integrators/registry.h"
#include "renderer/integrators/scatter_direction.h"
#include "renderer/integrators/track.h"

namespace brume {
namespace {

/// One path of channel c.
template <int C> Color trace(Ray ray, int c, SampleContext& context) {
  const Scene& scene = context.scene;
  const Sampler& sampler = context.sampler;
  std::optional<SurfaceHit> surface = close(ray, scene);
  if (context.diagnostics) diagnose_by_tracking<C>(ray, context);
  Color radiance = visible_lights(scene, ray, surface, [&](float t) { return transmittance_to<C>(ray, t, context); });
  float beta = 1;
  for (int bounce = 0;; ++bounce) {
    const ArenaScope scope(context.arena);
    ++context.statistics.rays;
    auto collisions = track<C>(ray, Decision::Flight, bounce, 0, context);
    for (int other = 0; other < C; ++other)
      if (other != c) collisions.drop(other);
    const Collision<C>* real = nullptr;
    for (int j = 0; !real; ++j) {
      const Collision<C>* at = collisions.next();
      if (!at) break;
      // Emission by the collision estimator: 1 / majorant at every tentative collision.
      radiance += at->emission * (beta / at->majorant);
      if (sampler.u1(Decision::RealCollision, bounce, j) * at->majorant < at->sigma_t[c]) real = at;
    }
    TrackedShadows<C> shadows(bounce, context);
    // Goes on from x; false when the path ends.
    const auto turn = [&](Vec3 x, const auto& scatterer) {
      if (bounce == scene.render.bounces) return false;
      const auto scattered = scatter_direction<C>(scatterer, x, bounce, context);
      beta *= scattered.weight[c];
      beta *= roulette(Color(beta), bounce, context);
      ray = {x, scattered.direction};
      return beta != 0;
    };
    if (real) {
      beta *= real->sigma_s[c] / real->sigma_t[c];
      if (beta == 0) return radiance;
      const Vec3 x = ray.at(real->t);
      const PhaseMixture<C> phase(scene, ray.direction, real->densities);
      light_at_point<C>(x, phase, Color(beta), bounce, 0, context.light_samples(), context, shadows);
      radiance += shadows.light();
      if (!turn(x, phase)) return radiance;
    } else {
      if (!surface) return radiance;
      light_at_surface<C>(*surface, Color(beta), bounce, 0, context.light_samples(), context, shadows);
      radiance += shadows.light();
      if (!turn(surface->position, DiffuseReflection<C>(surface->normal, surface->albedo))) return radiance;
    }
    surface = close(ray, scene);
  }
}

template <int C> Color trace_one_channel(const Ray& ray, SampleContext& context) {
  const int c = leading_channel<C>(context.sampler);
  const Color all = trace<C>(ray, c, context);
  if (C == 1) return all;
  Color only;
  only[c] = C * all[c];
  return only;
}

}  // namespace

Color DeltaTrackingIntegrator::radiance(const Ray& camera_ray, SampleContext& context) const {
  return context.scene.needs.channels == 1 ? trace_one_channel<1>(camera_ray, context)
                                           : trace_one_channel<3>(camera_ray, context);
}

IntegratorType delta_tracking_integrator_type() {
  return {integrator_table("delta_tracking", "Delta tracking",
                           "Unbiased rejection with one majorant for all of the medium (Raab 2006).",
                           {light_params(), path_params(), random_params()}),
          make_as<DeltaTrackingIntegrator>};
}

}  // namespace brume
