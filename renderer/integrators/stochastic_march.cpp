#include "renderer/integrators/stochastic_march.h"

#include "renderer/integrators/marched_path.h"
#include "renderer/integrators/marched_shadows.h"
#include "renderer/integrators/path.h"
#include "renderer/integrators/registry.h"
#include "renderer/integrators/scatter_direction.h"
#include "renderer/march/distribute.h"
#include "renderer/march/presence.h"
#include "renderer/march/shadow_march.h"

namespace brume {
namespace {

constexpr int kChunk = 32;  // steps marched before the random numbers are looked at again

template <int C> struct Marching {
  SampleContext& context;
  int bounce;
  Ray ray;
  Color beta;
  Spectrum<C> p;   // per channel: pdf of the path so far when that channel leads, relative
  int leader = 0;  // the channel whose transmittance the random numbers are compared with
  MarchedShadows<C> shadows{bounce, context};
  Color radiance = {};  // emission

  // The place where the path may go on.
  bool goes_on = false;
  Ray next = {};
  Color next_beta = {};
  Spectrum<C> next_p = {};

  /// The k-th distance is at an optical depth of the leader beyond `before`, inside the chunk.
  void scatter_at(const MarchRecord<C>& rec, const Spectrum<C>& before, float depth, int k, int chosen) {
    const auto lead = static_cast<std::size_t>(leader);
    const float* tau = rec.tau[lead];
    const float* above = std::upper_bound(tau + 1, tau + rec.n, depth);
    const int i = static_cast<int>(above - tau) - 1;
    const float sigma = rec.sigma_t[lead][i];
    const float t = std::min(rec.t[i] + (sigma > 0 ? (depth - tau[i]) / sigma : 0), rec.t[i + 1]);
    const RayPoint<C> at = evaluate(rec, t, i);

    // f = sigma_s T, p = sigma_t T for every channel that might have led.
    Spectrum<C> tracked;
    float pdf = 0;
    Color value = beta;
    for (int c = 0; c < C; ++c) {
      const float transmittance = std::exp(-before[c]) * at.transmittance[c];
      tracked[c] = p[c] * rec.sigma_t[static_cast<std::size_t>(c)][i] * transmittance;
      pdf += tracked[c] / C;
      if (C == 3) value[c] *= at.sigma_s[c] * transmittance;
    }
    if (C == 1) value *= at.sigma_s[0] * std::exp(-before[0]) * at.transmittance[0];
    if (!(pdf > 0) || is_black(value)) return;
    value *= 1 / pdf;

    const ArenaScope scope(context.arena);
    const Scene& scene = context.scene;
    const Vec3 x = ray.at(t);
    const PhaseMixture<C> phase(scene, ray.direction, rec, i, context.arena);
    light_at_point<C>(x, phase, value / static_cast<float>(samples()), bounce, k, 1, context, shadows);
    if (k == chosen) go_on(x, phase, value, tracked, pdf);
  }

  /// The distances from k on are beyond all of the medium, whose optical depth is `depth`: they are at the surface.
  void reflect_at(const SurfaceHit& surface, const Spectrum<C>& depth, int k, int chosen) {
    // f = T; p = T for every channel that might have led.
    Spectrum<C> tracked;
    float pdf = 0;
    Color value = beta;
    for (int c = 0; c < 3; ++c) value[c] *= std::exp(-depth[C == 1 ? 0 : c]);
    for (int c = 0; c < C; ++c) {
      tracked[c] = p[c] * std::exp(-depth[c]);
      pdf += tracked[c] / C;
    }
    if (!(pdf > 0)) return;
    value *= 1 / pdf;
    const int n = samples();
    light_at_surface<C>(surface, value * (static_cast<float>(n - k) / static_cast<float>(n)), bounce, n, n, context,
                        shadows);
    if (chosen >= k) go_on(surface.position, DiffuseReflection<C>(surface.normal, surface.albedo), value, tracked, pdf);
  }

  template <Scatterer<C> S> void go_on(Vec3 x, const S& scatterer, Color value, const Spectrum<C>& tracked, float pdf) {
    const auto scattered = scatter_direction<C>(scatterer, x, bounce, context);
    goes_on = true;
    next = {x, scattered.direction};
    next_beta = value * to_color(scattered.weight);
    for (int c = 0; c < C; ++c) next_p[c] = tracked[c] / pdf;
  }

  /// Distances on a ray, each with one sample of each light.
  int samples() const { return context.light_samples(); }

  /// @param surface  that closes the ray
  void march(const std::optional<SurfaceHit>& surface) {
    const Scene& scene = context.scene;
    const int n = samples();
    // Stratified numbers are sorted as they come.
    const auto depth_of = [&](int k) {
      const float xi = context.sampler.u1(Decision::DensityDistance, bounce, k);
      return -std::log1p(-std::min((static_cast<float>(k) + xi) / static_cast<float>(n), 0x1.fffffep-1f));
    };
    const int chosen =
        std::min(static_cast<int>(context.sampler.u1(Decision::BounceDistance, bounce) * static_cast<float>(n)), n - 1);
    const float offset = context.sampler.u1(Decision::MarchOffset, bounce);
    Spectrum<C> before;  // optical depth of the chunks behind
    const Presence presence = find_presence(scene.media, ray, context.arena);
    int k = 0;
    float depth = depth_of(0);
    const Interval inside = presence.empty() ? Interval{} : Interval{presence.edges.front(), presence.edges.back()};
    float step = scene.step_size;
    segment_count(inside.length(), step, context.statistics.march);
    // Far from the ray's origin the next float may be further away than all of the steps.
    const float end = inside.end, chunk = std::max(kChunk * step, 1e-6f * end);
    for (float from = inside.begin; from < end;) {
      const ArenaScope scope(context.arena);
      const float to = std::min(end, from + chunk);
      MarchRecord<C> rec =
          record_ray<C>({ray.origin, ray.direction, {from, to}}, {step, offset, scene.render.time}, context);
      from = to;
      if (rec.empty()) continue;
      distribute(rec, beta, context.arena);
      Color transmittance;
      for (int c = 0; c < 3; ++c) transmittance[c] = std::exp(-before[C == 1 ? 0 : c]);
      radiance += beta * transmittance * emitted_radiance(rec);
      const float reached = before[leader] + rec.tau[static_cast<std::size_t>(leader)][rec.n];
      while (k < n && depth < reached) {
        scatter_at(rec, before, depth - before[leader], k, chosen);
        if (++k < n) depth = depth_of(k);
      }
      for (int c = 0; c < C; ++c) before[c] += rec.tau[static_cast<std::size_t>(c)][rec.n];
      // Emission is collected on the whole ray, for it needs no random number.
      if (k == n && !scene.needs.emission) return;
    }
    if (surface && k < n) reflect_at(*surface, before, k, chosen);
  }
};

/// Transmittance for what the camera sees directly, by a march of its own.
template <int C> Color marched(const Ray& ray, float t, SampleContext& context) {
  const Scene& scene = context.scene;
  return to_color(
      shadow_transmittance<C>(scene.media, {ray.origin, ray.direction, {ray.span.begin, t}},
                              {scene.step_size, context.sampler.u1(Decision::MarchOffset), scene.render.time},
                              context.arena, context.statistics.march));
}

template <int C> Color trace(Ray ray, SampleContext& context) {
  const Scene& scene = context.scene;
  std::optional<SurfaceHit> surface = close(ray, scene);
  if (context.diagnostics) {
    const auto depth = shadow_optical_depth<C>(
        scene.media, ray, {scene.step_size, context.sampler.u1(Decision::MarchOffset), scene.render.time},
        context.arena, context.statistics.march);
    context.diagnostics->optical_depth = to_color(depth);
    for (int c = 0; c < 3; ++c) context.diagnostics->transmittance[c] = std::exp(-to_color(depth)[c]);
  }
  Color radiance = visible_lights(scene, ray, surface, [&](float t) { return marched<C>(ray, t, context); });
  auto p = filled<C>(1);
  const int leader = leading_channel<C>(context.sampler);
  Color beta(1);
  for (int bounce = 0;; ++bounce) {
    const ArenaScope scope(context.arena);
    ++context.statistics.rays;
    Marching<C> marching{context, bounce, ray, beta, p, leader};
    marching.march(surface);
    radiance += marching.radiance + marching.shadows.light();
    if (bounce == scene.render.bounces || !marching.goes_on) return radiance;
    beta = marching.next_beta;
    if (!is_black(beta)) beta *= roulette(beta, bounce, context);
    if (is_black(beta)) return radiance;
    ray = marching.next;
    surface = close(ray, scene);
    p = marching.next_p;
  }
}

}  // namespace

Color StochasticMarchIntegrator::radiance(const Ray& camera_ray, SampleContext& context) const {
  return context.scene.needs.channels == 1 ? trace<1>(camera_ray, context) : trace<3>(camera_ray, context);
}

IntegratorType stochastic_march_integrator_type() {
  return {integrator_table("stochastic_march", "Stochastic marching",
                           "Marches until the transmittance falls below a random number (Lafortune 1996, Pauly 2000).",
                           {light_params(), march_params(), path_params(), random_params()}),
          make_as<StochasticMarchIntegrator>};
}

}  // namespace brume
