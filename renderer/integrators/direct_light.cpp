#include "renderer/integrators/direct_light.h"

#include "renderer/march/density_sampling.h"
#include "renderer/march/equiangular.h"
#include "renderer/march/mis.h"
#include "renderer/march/shadow_march.h"

namespace brume {

template <int C> float PhaseMixture<C>::share(std::size_t m, int c) const {
  return scene_.media[m].sigma_s[c] * record_.medium_density[m][segment_];
}

template <int C> Spectrum<C> PhaseMixture<C>::value(float cos_theta) const {
  Spectrum<C> result;
  if (single()) {
    const float p = scene_.phases[0]->value(cos_theta);
    for (float& v : result.v) v = p;
    return result;
  }
  Spectrum<C> sum;
  for (std::size_t m = 0; m < scene_.media.size(); ++m) {
    const float p = scene_.phases[m]->value(cos_theta);
    for (int c = 0; c < C; ++c) result[c] += share(m, c) * p, sum[c] += share(m, c);
  }
  for (int c = 0; c < C; ++c) result[c] = sum[c] > 0 ? result[c] / sum[c] : 0;
  return result;
}

template <int C> typename PhaseMixture<C>::Sample PhaseMixture<C>::sample(Vec3 direction, float u_lobe, Vec2 u) const {
  Sample out;
  if (single()) {
    out.direction = scene_.phases[0]->sample(direction, u).direction;
    for (float& v : out.weight.v) v = 1;
    return out;
  }
  const std::size_t count = scene_.media.size();
  const auto total_share = [&](std::size_t m) {
    float sum = 0;
    for (int c = 0; c < C; ++c) sum += share(m, c);
    return sum;
  };
  float total = 0;
  for (std::size_t m = 0; m < count; ++m) total += total_share(m);
  std::size_t chosen = 0, last = 0;
  float rest = u_lobe * total;
  for (std::size_t m = 0; m < count; ++m) {
    if (total_share(m) == 0) continue;
    chosen = last = m;
    if (rest < total_share(m)) break;
    rest -= total_share(m);
  }
  out.direction = scene_.phases[chosen]->sample(direction, u).direction;
  const float cos_theta = dot(direction, out.direction);
  float pdf = 0;
  for (std::size_t m = 0; m < count; ++m) pdf += total_share(m) / total * scene_.phases[m]->value(cos_theta);
  out.weight = value(cos_theta);
  for (float& v : out.weight.v) v /= pdf;
  return out;
}

namespace {

template <int C> struct LightSampling {
  const MarchRecord<C>& record;
  const Ray& ray;
  int bounce;
  SampleContext& context;
  DensitySampling<C> density{record};

  /// sigma_s T phase L_i T_shadow at distance t: the integrand of single scattering, per channel.
  /// @param index  of the light sample, for its random numbers
  Color scattered_from(const Light& light, LightPoint point, const RayPoint<C>& at, int index) const {
    const Scene& scene = context.scene;
    Color scattered;
    for (int c = 0; c < 3; ++c) {
      const int channel = C == 1 ? 0 : c;
      scattered[c] = at.sigma_s[channel] * at.transmittance[channel];
    }
    if (is_black(scattered)) return {};

    const Vec3 x = ray.at(at.t);
    const PhaseMixture<C> phase(scene, record, at.segment);
    Ray shadow{x, {}, {}};
    if (point.kind == LightPoint::Kind::Environment) {
      // The phase function draws the direction; what is left of phase / pdf is the weight.
      const auto drawn = phase.sample(ray.direction, context.sampler.u1(Decision::PhaseLobe, bounce, index),
                                      context.sampler.u2(Decision::PhaseDirection, bounce, index));
      shadow.direction = drawn.direction;
      scattered *= to_color(drawn.weight) * light.environment_radiance();
    } else {
      const IncidentLight incident = light.incident(point, x);
      shadow.direction = incident.wi;
      shadow.span.end = incident.distance;
      scattered *= to_color(phase.value(dot(ray.direction, incident.wi))) * incident.irradiance;
    }
    if (point.kind != LightPoint::Kind::Finite) shadow.span.end = std::numeric_limits<float>::infinity();
    if (is_black(scattered)) return {};

    ++context.statistics.shadow_rays;
    const MarchSettings settings{scene.shadow_step_size, context.sampler.u1(Decision::ShadowOffset, bounce, index),
                                 scene.render.time};
    return scattered *
           to_color(shadow_transmittance<C>(scene.media, shadow, settings, context.arena, context.statistics.march));
  }

  /// One light sample by density sampling, already divided by the pdf and by n.
  /// @param u  of the distance.  @param n  samples of this technique, on average over the passes
  /// @param other  the technique it is combined with, or null
  Color by_density(const Light& light, const LightPoint& point, float u, float n, int index,
                   const EquiangularSampling* other) const {
    const DistanceSample drawn = density.sample(u);
    const RayPoint<C> at = evaluate(record, drawn.t);
    const float pdf = density.pdf(at);
    if (!(pdf > 0)) return {};
    const float weight = other ? mis_weight(context.scene.render.mis_heuristic, pdf, other->pdf(drawn.t)) : 1;
    if (weight == 0) return {};
    return scattered_from(light, point, at, index) * (weight / (n * pdf));
  }

  Color by_equiangular(const Light& light, const LightPoint& point, float u, float n, int index,
                       const EquiangularSampling& equiangular, bool combined) const {
    const DistanceSample drawn = equiangular.sample(u);
    if (!(drawn.pdf_t > 0)) return {};
    const RayPoint<C> at = evaluate(record, drawn.t);
    const float weight = combined ? mis_weight(context.scene.render.mis_heuristic, drawn.pdf_t, density.pdf(at)) : 1;
    if (weight == 0) return {};
    return scattered_from(light, point, at, index) * (weight / (n * drawn.pdf_t));
  }

  /// A number for `distance` in the j-th of the strata: as many as the technique has samples in this very pass, or the
  /// strata would not cover [0,1) just once.
  float stratified(Decision distance, int j, int strata, int index) const {
    const float xi = context.sampler.u1(distance, bounce, index);
    return std::min((static_cast<float>(j) + xi) / static_cast<float>(strata), 0x1.fffffep-1f);
  }

  /// All the samples of one light.  @param first_index  of its first light sample
  Color from_light(const Light& light, int samples, int first_index) const {
    const RenderSettings& render = context.scene.render;
    Color sum;
    // MIS gives half of the samples to each technique; of an odd number the odd one alternates between passes, starting
    // with either at random, so that every single pass is unbiased over the pixels.
    const bool odd_pass =
        (context.sampler.sample() & 1) != (context.sampler.per_pixel(Decision::TechniquePhase) < 0.5f);
    const int of_density = (samples + (odd_pass ? 1 : 0)) / 2;
    for (int k = 0; k < samples; ++k) {
      const int index = first_index + k;
      const LightPoint point = light.sample_point(context.sampler.u2(Decision::LightPoint, bounce, index));
      const Interval lit = intersect(record.span(), light.lit_part(point, {ray.origin, ray.direction, record.span()}));
      if (lit.empty()) continue;
      if (point.kind != LightPoint::Kind::Finite || render.distance_sampling == DistanceSampling::Density) {
        sum += by_density(light, point, stratified(Decision::DensityDistance, k, samples, index),
                          static_cast<float>(samples), index, nullptr);
        continue;
      }
      const EquiangularSampling equiangular(ray, point.position, lit);
      if (render.distance_sampling == DistanceSampling::Equiangular) {
        sum += by_equiangular(light, point, stratified(Decision::EquiangularDistance, k, samples, index),
                              static_cast<float>(samples), index, equiangular, false);
        continue;
      }
      const float each = 0.5f * static_cast<float>(samples);
      if (k < of_density)
        sum += by_density(light, point, stratified(Decision::DensityDistance, k, of_density, index), each, index,
                          &equiangular);
      else
        sum += by_equiangular(light, point,
                              stratified(Decision::EquiangularDistance, k - of_density, samples - of_density, index),
                              each, index, equiangular, true);
    }
    return sum;
  }
};

}  // namespace

template <int C>
Color direct_light(const MarchRecord<C>& record, const Ray& ray, Color beta, int bounce, SampleContext& context) {
  const Scene& scene = context.scene;
  const LightSampling<C> sampling{record, ray, bounce, context};
  const int lights = static_cast<int>(scene.lights.size()), samples = scene.render.light_samples;
  Color sum;
  if (scene.render.light_selection == LightSelection::All || lights < 2) {
    for (int l = 0; l < lights; ++l)
      sum += sampling.from_light(*scene.lights[static_cast<std::size_t>(l)], samples, l * samples);
  } else {
    const float u = context.sampler.u1(Decision::LightChoice, bounce);
    const int chosen = std::min(static_cast<int>(u * static_cast<float>(lights)), lights - 1);
    sum = sampling.from_light(*scene.lights[static_cast<std::size_t>(chosen)], samples, 0) * static_cast<float>(lights);
  }
  return beta * sum;
}

template class PhaseMixture<1>;
template class PhaseMixture<3>;
template Color direct_light<1>(const MarchRecord<1>&, const Ray&, Color, int, SampleContext&);
template Color direct_light<3>(const MarchRecord<3>&, const Ray&, Color, int, SampleContext&);

}  // namespace brume
