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
  Color beta;
  int bounce;
  SampleContext& context;
  MarchedShadows<C>& shadows;
  DensitySampling<C> density{record};

  /// sigma_s T L_scattered at a point of the ray, whose shadow is left to be seen: the integrand of single scattering
  /// over the densities of the light direction, times `factor`, which holds what divides it.
  void carry(const Light& light, const IncomingLight& in, const RayPoint<C>& at, float factor, const LightNumbers& numbers,
             int k) const {
    Color carried = beta * in.scattered * factor;
    for (int c = 0; c < 3; ++c) {
      const int channel = C == 1 ? 0 : c;
      carried[c] *= at.sigma_s[channel] * at.transmittance[channel];
    }
    if (!is_black(carried)) shadows.add(light, {ray.at(at.t), in.wi, {0, in.distance}}, carried, numbers, k);
  }

  PhaseMixture<C> phase_at(const RayPoint<C>& at) const {
    return PhaseMixture<C>(context.scene, ray.direction, record, at.segment, context.arena);
  }

  /// The part of the record that a point of the light can reach.
  Interval lit_part(const Light& light, const LightPoint& point) const {
    return intersect(record.span(), light.lit_part(point, {ray.origin, ray.direction, record.span()}));
  }

  /// One light sample by density sampling. A sample is a distance and a direction; in MIS the other technique might
  /// have drawn both.
  /// @param u  of the distance.  @param factor  one over the samples of this technique, on average over the passes
  void by_density(const Light& light, const LightPoint& point, float u, float factor, const LightNumbers& numbers, int k,
                  bool combined) const {
    const ArenaScope scope(context.arena);
    const RayPoint<C> at = density.sample(u);
    const float pdf = density.pdf(at);
    if (!(pdf > 0)) return;
    const LightTechnique<C> technique(light, context, bounce, numbers.index(k));
    const IncomingLight in = technique.draw(point, ray.at(at.t), phase_at(at));
    if (is_black(in.scattered)) return;
    float weight = 1;
    if (combined) {
      const Interval lit = lit_part(light, in.point);
      const float other = lit.empty() ? 0 : EquiangularSampling(ray, in.point.position, lit).pdf(at.t);
      weight = mis_weight(context.scene.render.mis_heuristic, pdf * in.pdf_ratio, other);
    }
    carry(light, in, at, factor * weight / pdf, numbers, k);
  }

  void by_equiangular(const Light& light, const LightPoint& point, float u, float factor, const LightNumbers& numbers,
                      int k, bool combined) const {
    const Interval lit = lit_part(light, point);
    if (lit.empty()) return;
    const ArenaScope scope(context.arena);
    const DistanceSample drawn = EquiangularSampling(ray, point.position, lit).sample(u);
    if (!(drawn.pdf_t > 0)) return;
    const RayPoint<C> at = evaluate(record, drawn.t);
    const LightTechnique<C> technique(light, context, bounce, numbers.index(k));
    const IncomingLight in = technique.towards(point, ray.at(at.t), phase_at(at));
    if (is_black(in.scattered)) return;
    const float weight =
        combined ? mis_weight(context.scene.render.mis_heuristic, drawn.pdf_t, density.pdf(at) * in.pdf_ratio) : 1;
    carry(light, in, at, factor * weight / drawn.pdf_t, numbers, k);
  }

  /// All the samples of one light.  @param weight  of the light
  void from_light(const Light& light, float weight, const LightNumbers& numbers) const {
    const DistanceSampling mode = context.scene.render.distance_sampling;
    const int samples = numbers.count();
    // All points of a light are of one kind.
    const bool distant = light.sample_point(numbers.point(0)).kind != LightPoint::Kind::Finite;
    const bool combined = mode == DistanceSampling::Mis && !distant;
    int of_density = mode == DistanceSampling::Density || distant ? samples : 0;
    if (combined) {
      // Half of the samples to each technique; of an odd number the odd one alternates between passes, starting with
      // either at random, so that every single pass is unbiased over the pixels.
      const bool odd_pass =
          (context.sampler.sample() & 1) != (context.sampler.per_pixel(Decision::TechniquePhase) < 0.5f);
      of_density = (samples + (odd_pass ? 1 : 0)) / 2;
    }
    const float share = (combined ? 2 : 1) * weight / static_cast<float>(samples);
    // Strata: as many as the technique has samples in this very pass, or they would not cover [0,1) just once.
    if (of_density > 0) {
      const auto u = numbers.distances(Decision::DensityDistance);
      for (int k = 0; k < of_density; ++k)
        by_density(light, light.sample_point(numbers.point(k)), u(k, of_density), share, numbers, k, combined);
    }
    const int about_light = samples - of_density;
    if (about_light > 0) {
      const auto u = numbers.distances(Decision::EquiangularDistance);
      for (int j = 0; j < about_light; ++j) {
        const int k = of_density + j;
        by_equiangular(light, light.sample_point(numbers.point(k)), u(j, about_light), share, numbers, k, combined);
      }
    }
  }
};

}  // namespace

template <int C>
void direct_light(const MarchRecord<C>& record, const Ray& ray, Color beta, int bounce, SampleContext& context,
                  MarchedShadows<C>& shadows) {
  const LightSampling<C> sampling{record, ray, beta, bounce, context, shadows};
  for_lights(bounce, 0, context.scene.render.light_samples, context,
             [&](const Light& light, float weight, const LightNumbers& numbers) { sampling.from_light(light, weight, numbers); });
}

template void direct_light<1>(const MarchRecord<1>&, const Ray&, Color, int, SampleContext&, MarchedShadows<1>&);
template void direct_light<3>(const MarchRecord<3>&, const Ray&, Color, int, SampleContext&, MarchedShadows<3>&);

}  // namespace brume
