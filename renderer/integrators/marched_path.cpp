#include "renderer/integrators/marched_path.h"

#include "renderer/integrators/path.h"
#include "renderer/integrators/scatter_direction.h"
#include "renderer/march/distribute.h"

namespace brume {

template <int C> MarchRecord<C> record_ray(const Ray& ray, const MarchSettings& settings, SampleContext& context) {
  const Scene& scene = context.scene;
  return record<C>(scene.media, {scene.needs.emission, scene.needs.overlap}, ray, settings, context.arena,
                   context.statistics.march);
}

template <int C> Spectrum<C> transmittance_to(const MarchRecord<C>& record, float t) {
  if (record.empty() || t <= record.span().begin) return filled<C>(1);
  return t >= record.span().end ? transmittance(record) : evaluate(record, t).transmittance;
}

template <int C> void diagnose(const MarchRecord<C>& record, RayDiagnostics& out) {
  out.segments = record.n;
  out.transmittance = to_color(transmittance(record));
  for (int c = 0; c < 3 && !record.empty(); ++c)
    out.optical_depth[c] = record.tau[static_cast<std::size_t>(C == 1 ? 0 : c)][record.n];
}

namespace {

/// Goes on in the medium. @return false when it cannot
template <int C>
bool scatter_in_medium(const MarchRecord<C>& record, Ray& ray, Color& beta, int bounce, SampleContext& context) {
  const DensitySampling<C> density(record, PlaceInSegment::Drawn);
  const auto [at, pdf] = density.sample(context.sampler.u1(Decision::BounceDistance, bounce));
  if (!(pdf > 0)) return false;
  const Vec3 x = ray.at(at.t);
  const PhaseMixture<C> phase(context.scene, ray.direction, record, at.segment, context.arena);
  const auto scattered = scatter_direction<C>(phase, x, bounce, context);
  Spectrum<C> factor;
  for (int c = 0; c < C; ++c) factor[c] = at.sigma_s[c] * at.transmittance[c] / pdf * scattered.weight[c];
  beta *= to_color(factor);
  ray = {x, scattered.direction};  // without a third {}, which would be an empty span
  return true;
}

}  // namespace

template <int C>
bool scatter(const MarchRecord<C>& record, const std::optional<SurfaceHit>& surface, Ray& ray, Color& beta, int bounce,
             SampleContext& context) {
  const float scattered = record.empty() ? 0 : record.scattered();
  const Spectrum<C> behind = surface ? transmittance(record) : Spectrum<C>{};
  const Spectrum<C> weights = channel_weights<C>(beta);
  float reflected = 0;
  if (surface)
    for (int c = 0; c < C; ++c) reflected += weights[c] * behind[c] * surface->albedo[c];
  const float total = scattered + reflected;
  if (!(total > 0)) return false;

  const bool choose = scattered > 0 && reflected > 0;
  const float u = choose ? context.sampler.u1(Decision::MediumOrSurface, bounce) : 0;
  if (scattered > 0 && u * total < scattered) {
    if (!scatter_in_medium(record, ray, beta, bounce, context)) return false;
    beta *= total / scattered;
  } else {
    const DiffuseReflection<C> reflection(surface->normal, surface->albedo);
    const auto turned = scatter_direction<C>(reflection, surface->position, bounce, context);
    beta *= to_color(behind) * to_color(turned.weight) * (total / reflected);
    ray = {surface->position, turned.direction};
  }
  if (!is_black(beta)) beta *= roulette(beta, bounce, context);
  return !is_black(beta);
}

template MarchRecord<1> record_ray(const Ray&, const MarchSettings&, SampleContext&);
template MarchRecord<3> record_ray(const Ray&, const MarchSettings&, SampleContext&);
template Spectrum<1> transmittance_to(const MarchRecord<1>&, float);
template Spectrum<3> transmittance_to(const MarchRecord<3>&, float);
template void diagnose(const MarchRecord<1>&, RayDiagnostics&);
template void diagnose(const MarchRecord<3>&, RayDiagnostics&);
template bool scatter(const MarchRecord<1>&, const std::optional<SurfaceHit>&, Ray&, Color&, int, SampleContext&);
template bool scatter(const MarchRecord<3>&, const std::optional<SurfaceHit>&, Ray&, Color&, int, SampleContext&);

}  // namespace brume
