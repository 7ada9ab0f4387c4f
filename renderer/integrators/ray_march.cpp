#include "renderer/integrators/ray_march.h"

#include "renderer/integrators/marched_path.h"
#include "renderer/integrators/marched_shadows.h"
#include "renderer/integrators/path.h"
#include "renderer/integrators/registry.h"
#include "renderer/march/distribute.h"
#include "renderer/march/ray_point.h"

namespace brume {

/// Light samples whose transmittance is marched, or taken from a map.
template <int C> class RayMarchIntegrator::Shadows {
 public:
  Shadows(const RayMarchIntegrator& integrator, int bounce, SampleContext& context)
      : integrator_(integrator), scene_(context.scene), marched_(bounce, context) {}

  void add(const Light& light, const Ray& shadow, Color carried, const ShadowNumbers& numbers) {
    if (const DeepShadowMap* map = integrator_.shadow_map(scene_, light))
      cached_ += carried * map->transmittance(shadow.origin);
    else
      marched_.add(light, shadow, carried, numbers);
  }
  Color light() { return cached_ + marched_.light(); }

 private:
  const RayMarchIntegrator& integrator_;
  const Scene& scene_;
  MarchedShadows<C> marched_;
  Color cached_;
};

template <int C> Color RayMarchIntegrator::trace(Ray ray, SampleContext& context) const {
  const Scene& scene = context.scene;
  Color radiance, beta(1);
  for (int bounce = 0;; ++bounce) {
    const ArenaScope scope(context.arena);
    ++context.statistics.rays;
    const std::optional<SurfaceHit> surface = close(ray, scene);
    const MarchSettings settings{scene.step_size, context.sampler.u1(Decision::MarchOffset, bounce), scene.render.time,
                                 true};
    MarchRecord<C> rec = record_ray<C>(ray, settings, context);
    if (!rec.empty()) distribute(rec, beta, context.arena);
    if (bounce == 0) {
      if (context.diagnostics) diagnose(rec, *context.diagnostics);
      radiance = visible_lights(scene, ray, surface, [&](float t) { return to_color(transmittance_to(rec, t)); });
    }
    if (!rec.empty()) radiance += beta * emitted_radiance(rec);
    Shadows<C> shadows(*this, bounce, context);

    // The samples of a light are numbered along the ray, step after step, so that they are spread over all of them.
    const int samples = context.light_samples(), all = rec.n * samples;
    const bool scatters = !rec.empty() && rec.scattered() > 0;
    for_lights(bounce, 0, all, context, [&](const Light& light, float weight, const LightNumbers& numbers) {
      for (int i = 0; scatters && i < rec.n; ++i) {
        if (rec.is_clear(i)) continue;
        const ArenaScope step_scope(context.arena);
        const float width = rec.t[i + 1] - rec.t[i];
        const RayPoint<C> at = looked_up_point(rec, i);
        Color scattered = beta * (weight / static_cast<float>(samples));
        for (int c = 0; c < 3; ++c) {
          const int channel = C == 1 ? 0 : c;
          scattered[c] *= at.sigma_s[channel] * at.transmittance[channel] * width;
        }
        if (is_black(scattered)) continue;
        const PhaseMixture<C> phase(scene, ray.direction, rec, i, context.arena);
        for (int k = i * samples; k < (i + 1) * samples; ++k)
          light_sample_at<C>(ray.at(at.t), phase, scattered, light, numbers, bounce, k, context, shadows);
      }
    });
    if (surface)
      // Its place is behind those of all steps, and the same in every pass.
      light_at_surface<C>(*surface, beta * to_color(transmittance(rec)), bounce, kMaxSegments, samples, context,
                          shadows);
    radiance += shadows.light();
    if (bounce == scene.render.bounces) return radiance;
    if (!scatter(rec, surface, ray, beta, bounce, context)) return radiance;
  }
}

Color RayMarchIntegrator::radiance(const Ray& camera_ray, SampleContext& context) const {
  return context.scene.needs.channels == 1 ? trace<1>(camera_ray, context) : trace<3>(camera_ray, context);
}

IntegratorType ray_march_integrator_type() {
  return {integrator_table("ray_march", "Ray-marching",
                           "Samples the lights at every step (Perlin & Hoffert 1989); bounces are Brume's addition.",
                           {light_params(), march_params(), path_params(), random_params()}),
          make_as<RayMarchIntegrator>};
}

}  // namespace brume
