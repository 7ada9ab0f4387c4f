#include "renderer/integrators/direct_light.h"

#include "renderer/integrators/marched_path.h"
#include "renderer/integrators/path.h"
#include "renderer/march/density_sampling.h"
#include "renderer/march/equiangular.h"
#include "renderer/march/mis.h"

namespace brume {
namespace {

template <int C> struct LightSampling {
  const MarchRecord<C>& record;
  const Ray& ray;
  int bounce;
  SampleContext& context;
  DensitySampling<C> density{record};

  /// sigma_s T L_scattered T_shadow at a point of the ray: the integrand of single scattering over the densities of
  /// the light direction, per channel.
  Color carried(const IncomingLight& in, const RayPoint<C>& at, int index) const {
    Color sum = in.scattered;
    for (int c = 0; c < 3; ++c) {
      const int channel = C == 1 ? 0 : c;
      sum[c] *= at.sigma_s[channel] * at.transmittance[channel];
    }
    if (is_black(sum)) return {};
    ++context.statistics.shadow_rays;
    const Ray shadow{ray.at(at.t), in.wi, {0, in.distance}};
    return sum * to_color(marched_shadow<C>(shadow, bounce, index, context));
  }

  PhaseMixture<C> phase_at(const RayPoint<C>& at) const {
    return PhaseMixture<C>(context.scene, ray.direction, record, at.segment, context.arena);
  }

  /// The part of the record that a point of the light can reach.
  Interval lit_part(const Light& light, const LightPoint& point) const {
    return intersect(record.span(), light.lit_part(point, {ray.origin, ray.direction, record.span()}));
  }

  /// One light sample by density sampling, already divided by the pdf and by n. A sample is a distance and a direction;
  /// in MIS the other technique might have drawn both.
  /// @param u  of the distance.  @param n  samples of this technique, on average over the passes
  Color by_density(const Light& light, const LightPoint& point, float u, float n, int index, bool combined) const {
    const ArenaScope scope(context.arena);
    const DistanceSample drawn = density.sample(u);
    const RayPoint<C> at = evaluate(record, drawn.t);
    const float pdf = density.pdf(at);
    if (!(pdf > 0)) return {};
    const LightTechnique<C> technique(light, context, bounce, index);
    const IncomingLight in = technique.draw(point, ray.at(at.t), phase_at(at));
    if (is_black(in.scattered)) return {};
    float weight = 1;
    if (combined) {
      const Interval lit = lit_part(light, in.point);
      const float other = lit.empty() ? 0 : EquiangularSampling(ray, in.point.position, lit).pdf(at.t);
      weight = mis_weight(context.scene.render.mis_heuristic, pdf * in.pdf_ratio, other);
    }
    return weight == 0 ? Color{} : carried(in, at, index) * (weight / (n * pdf));
  }

  Color by_equiangular(const Light& light, const LightPoint& point, Interval lit, float u, float n, int index,
                       bool combined) const {
    const ArenaScope scope(context.arena);
    const DistanceSample drawn = EquiangularSampling(ray, point.position, lit).sample(u);
    if (!(drawn.pdf_t > 0)) return {};
    const RayPoint<C> at = evaluate(record, drawn.t);
    const LightTechnique<C> technique(light, context, bounce, index);
    const IncomingLight in = technique.towards(point, ray.at(at.t), phase_at(at));
    if (is_black(in.scattered)) return {};
    const float weight =
        combined ? mis_weight(context.scene.render.mis_heuristic, drawn.pdf_t, density.pdf(at) * in.pdf_ratio) : 1;
    return weight == 0 ? Color{} : carried(in, at, index) * (weight / (n * drawn.pdf_t));
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
      const bool distant = point.kind != LightPoint::Kind::Finite;
      if (distant || render.distance_sampling == DistanceSampling::Density) {
        sum += by_density(light, point, stratified(Decision::DensityDistance, k, samples, index),
                          static_cast<float>(samples), index, false);
        continue;
      }
      const bool combined = render.distance_sampling == DistanceSampling::Mis;
      if (combined && k < of_density) {
        sum += by_density(light, point, stratified(Decision::DensityDistance, k, of_density, index),
                          0.5f * static_cast<float>(samples), index, true);
        continue;
      }
      const Interval lit = lit_part(light, point);
      if (lit.empty()) continue;
      const int first = combined ? of_density : 0;
      sum += by_equiangular(light, point, lit,
                            stratified(Decision::EquiangularDistance, k - first, samples - first, index),
                            (combined ? 0.5f : 1.0f) * static_cast<float>(samples), index, combined);
    }
    return sum;
  }
};

}  // namespace

template <int C>
Color direct_light(const MarchRecord<C>& record, const Ray& ray, Color beta, int bounce, SampleContext& context) {
  const LightSampling<C> sampling{record, ray, bounce, context};
  const int samples = context.scene.render.light_samples;
  Color sum;
  for_lights(bounce, 0, samples, context, [&](const Light& light, float weight, int first) {
    sum += sampling.from_light(light, samples, first) * weight;
  });
  return beta * sum;
}

template Color direct_light<1>(const MarchRecord<1>&, const Ray&, Color, int, SampleContext&);
template Color direct_light<3>(const MarchRecord<3>&, const Ray&, Color, int, SampleContext&);

}  // namespace brume
