#include "renderer/integrators/decoupled.h"

#include "renderer/integrators/direct_light.h"
#include "renderer/integrators/registry.h"
#include "renderer/integrators/scatter_direction.h"
#include "renderer/march/density_sampling.h"
#include "renderer/march/distribute.h"

namespace brume {
namespace {

// Roulette begins late and never below this: earlier or rarer survival trades noise for fireflies.
constexpr int kRouletteBounce = 3;
constexpr float kLeastSurvival = 0.05f;

/// Transmittance from the ray's origin to t, read off the record.
template <int C> Spectrum<C> transmittance_to(const MarchRecord<C>& record, float t) {
  Spectrum<C> clear;
  for (float& v : clear.v) v = 1;
  if (record.empty() || t <= record.span().begin) return clear;
  return t >= record.span().end ? transmittance(record) : evaluate(record, t).transmittance;
}

/// What the camera sees of the lights themselves, through the medium in front of them. Lamps do not block.
template <int C> Color visible_lights(const MarchRecord<C>& record, const Ray& ray, const Scene& scene) {
  Color sum;
  for (const auto& light : scene.lights) {
    if (!light->visible_to_camera) continue;
    if (const auto hit = light->hit(ray)) sum += hit->radiance * to_color(transmittance_to(record, hit->t));
  }
  return sum;
}

template <int C> void diagnose(const MarchRecord<C>& record, RayDiagnostics& out) {
  out.segments = record.n;
  out.transmittance = to_color(transmittance(record));
  for (int c = 0; c < 3 && !record.empty(); ++c)
    out.optical_depth[c] = record.tau[static_cast<std::size_t>(C == 1 ? 0 : c)][record.n];
}

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

    // record
    const MarchSettings settings{scene.step_size, sampler.u1(Decision::MarchOffset, bounce), scene.render.time};
    MarchRecord<C> rec = record<C>(scene.media, {scene.needs.emission, scene.needs.overlap}, ray, settings,
                                   context.arena, context.statistics.march);
    // distribute
    if (!rec.empty()) distribute(rec, beta, context.arena);
    if (bounce == 0) {
      if (context.diagnostics) diagnose(rec, *context.diagnostics);
      // Scattered rays add no light that they meet: the light samples at every bounce have counted it all.
      radiance = visible_lights(rec, ray, scene);
    }
    if (rec.empty()) return radiance;

    // estimate
    radiance += beta * emitted_radiance(rec);
    if (!(rec.scattered() > 0)) return radiance;
    radiance += direct_light(rec, ray, beta, bounce, context);

    // bounce
    if (bounce == scene.render.bounces) return radiance;
    const DensitySampling<C> density(rec);
    const DistanceSample drawn = density.sample(sampler.u1(Decision::BounceDistance, bounce));
    const RayPoint<C> at = evaluate(rec, drawn.t);
    const float pdf = density.pdf(at);
    if (!(pdf > 0)) return radiance;
    const Vec3 x = ray.at(drawn.t);
    const PhaseMixture<C> phase(scene, rec, at.segment, context.arena);
    const auto scattered = scatter_direction(phase, x, ray.direction, bounce, context);
    Spectrum<C> factor;
    for (int c = 0; c < C; ++c) factor[c] = at.sigma_s[c] * at.transmittance[c] / pdf * scattered.weight[c];
    beta *= to_color(factor);
    if (is_black(beta)) return radiance;
    if (scene.render.russian_roulette && bounce >= kRouletteBounce) {
      const float survival = std::clamp(max_channel(beta), kLeastSurvival, 1.0f);
      if (sampler.u1(Decision::Roulette, bounce) >= survival) return radiance;
      beta *= 1 / survival;
    }
    ray = {x, scattered.direction};  // without a third {}, which would be an empty span
  }
}

}  // namespace

Color DecoupledIntegrator::radiance(const Ray& camera_ray, SampleContext& context) const {
  return context.scene.needs.channels == 1 ? trace<1>(camera_ray, context) : trace<3>(camera_ray, context);
}

IntegratorType decoupled_integrator_type() {
  ParamTable table{"decoupled",
                   "Decoupled ray-marching",
                   "Marches each ray once, then draws light samples from what it recorded (Kulla 2011).",
                   {},
                   {}};
  for (const auto& group : {sampling_params(), march_params(), path_params()})
    table.params.insert(table.params.end(), group.begin(), group.end());
  return {std::move(table),
          []() -> std::unique_ptr<const Integrator> { return std::make_unique<DecoupledIntegrator>(); }};
}

}  // namespace brume
