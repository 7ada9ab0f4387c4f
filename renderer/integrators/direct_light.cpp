#include "renderer/integrators/direct_light.h"

#include "renderer/integrators/marched_path.h"
#include "renderer/integrators/path.h"
#include "renderer/march/density_sampling.h"
#include "renderer/march/equiangular.h"
#include "renderer/march/mis.h"
#include "renderer/march/product_sampling.h"

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
  void carry(const Light& light, const IncomingLight& in, const RayPoint<C>& at, float factor,
             const LightNumbers& numbers, int k) const {
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

  /// One light sample at a distance that was drawn without regard to the point. A sample is a distance and a direction;
  /// in MIS equi-angular sampling might have drawn both.
  /// @param factor  one over the samples of this technique, on average over the passes
  void at_distance(const RayPoint<C>& at, float pdf, const Light& light, const LightPoint& point, float factor,
                   const LightNumbers& numbers, int k, bool combined) const {
    if (!(pdf > 0)) return;
    const ArenaScope scope(context.arena);
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

  /// @param u  of the distance
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

  void by_product(const Light& light, const LightPivot& pivot, float weight, const LightNumbers& numbers) const {
    const ArenaScope scope(context.arena);
    const ProductSampling<C> product = product_with(light, pivot);
    if (!(product.total() > 0)) return;
    const int samples = numbers.count();
    const auto u = numbers.distances(Decision::DensityDistance);
    for (int k = 0; k < samples; ++k) {
      const auto [at, pdf] = product.sample(u(k, samples));
      at_distance(at, pdf, light, light.sample_point(numbers.point(k)), weight / static_cast<float>(samples), numbers,
                  k, false);
    }
  }

  ProductSampling<C> product_with(const Light& light, const LightPivot& pivot) const {
    const Scene& scene = context.scene;
    const LightPoint middle{LightPoint::Kind::Finite, pivot.position, {}, pivot.normal};
    const bool has_one_lit_part = pivot.normal != Vec3() || pivot.radius == 0;
    return {record,
            ray,
            pivot,
            has_one_lit_part ? lit_part(light, middle) : record.span(),
            scene.phases.size() == 1 ? scene.phases[0].get() : nullptr,
            context.arena};
  }

  /// What a light adds to the ray unless there are shadows, roughly.
  float promise(const Light& light, const LightNumbers& numbers) const {
    const ArenaScope scope(context.arena);
    if (const auto pivot = light.pivot()) {
      const float turned = context.scene.phases.size() == 1 ? 1 : kInv4Pi;  // is in the product already, or not
      return luminance(pivot->intensity) * product_with(light, *pivot).total() * turned;
    }
    const LightPoint point = light.sample_point(numbers.point(0));
    const Interval span = record.span();
    const Color irradiance = point.kind == LightPoint::Kind::Environment
                                 ? light.environment_radiance() * (4 * kPi)
                                 : light.incident(point, ray.at(0.5f * (span.begin + span.end))).irradiance;
    return luminance(irradiance) * record.scattered() * kInv4Pi;
  }

  bool picks_by_product() const {
    const Scene& scene = context.scene;
    return scene.render.distance_sampling == DistanceSampling::Product &&
           scene.render.light_selection == LightSelection::One && scene.lights.size() > 1;
  }

  /// All samples go to one light, picked by what the lights promise; each by a tenth of what it would be among equals
  /// at least, for a promise is not kept to the letter.
  void from_picked_light(int samples) const {
    const ArenaScope scope(context.arena);
    const auto& lights = context.scene.lights;
    const LightNumbers numbers(context.sampler, bounce, 0, samples);
    float* promises = context.arena.template alloc_span<float>(lights.size()).data();
    float sum = 0;
    for (std::size_t l = 0; l < lights.size(); ++l) sum += promises[l] = promise(*lights[l], numbers);
    const float least = sum > 0 ? 0.1f * sum / static_cast<float>(lights.size()) : 1;
    float total = 0;
    for (std::size_t l = 0; l < lights.size(); ++l) total += promises[l] = std::max(promises[l], least);
    float rest = context.sampler.u1(Decision::LightChoice, bounce) * total;
    std::size_t picked = 0;
    while (picked + 1 < lights.size() && rest >= promises[picked]) rest -= promises[picked++];
    from_light(*lights[picked], total / promises[picked], numbers);
  }

  /// All the samples of one light.  @param weight  of the light
  void from_light(const Light& light, float weight, const LightNumbers& numbers) const {
    const DistanceSampling mode = context.scene.render.distance_sampling;
    const int samples = numbers.count();
    const auto pivot = mode == DistanceSampling::Product ? light.pivot() : std::nullopt;
    if (pivot) return by_product(light, *pivot, weight, numbers);
    // All points of a light are of one kind.
    const bool distant = light.sample_point(numbers.point(0)).kind != LightPoint::Kind::Finite;
    const bool combined = mode == DistanceSampling::Mis && !distant;
    int of_density = mode == DistanceSampling::Equiangular && !distant ? 0 : samples;
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
      for (int k = 0; k < of_density; ++k) {
        const RayPoint<C> at = density.sample(u(k, of_density));
        at_distance(at, density.pdf(at), light, light.sample_point(numbers.point(k)), share, numbers, k, combined);
      }
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
void direct_light(const MarchRecord<C>& record, const Ray& ray, Color beta, int bounce, int samples,
                  SampleContext& context, MarchedShadows<C>& shadows) {
  const LightSampling<C> sampling{record, ray, beta, bounce, context, shadows};
  if (sampling.picks_by_product()) return sampling.from_picked_light(samples);
  for_lights(bounce, 0, samples, context, [&](const Light& light, float weight, const LightNumbers& numbers) {
    sampling.from_light(light, weight, numbers);
  });
}

template void direct_light<1>(const MarchRecord<1>&, const Ray&, Color, int, int, SampleContext&, MarchedShadows<1>&);
template void direct_light<3>(const MarchRecord<3>&, const Ray&, Color, int, int, SampleContext&, MarchedShadows<3>&);

}  // namespace brume
