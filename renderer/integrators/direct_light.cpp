#include "renderer/integrators/direct_light.h"

#include "renderer/integrators/marched_path.h"
#include "renderer/integrators/path.h"
#include "renderer/march/density_sampling.h"
#include "renderer/march/equiangular_sampling.h"
#include "renderer/march/mis.h"
#include "renderer/march/tracking.h"

namespace brume {
namespace {

template <int C> struct LightSampling {
  const MarchRecord<C>& record;
  const Ray& ray;
  Color beta;
  int bounce;
  SampleContext& context;
  MarchedShadows<C>& shadows;
  DensitySampling<C> density{record, PlaceInSegment::LookedUp};

  /// Equi-angular sampling about the last point that was asked for: a point light has no other, and its angles are
  /// dear.
  struct About {
    LightPoint point;
    std::optional<EquiangularSampling<C>> sampling;  // none: the point does not light the record
  };
  mutable std::optional<About> about_last = {};

  const std::optional<EquiangularSampling<C>>& about(const Light& light, const LightPoint& point) const {
    if (!about_last || about_last->point != point) {
      const Interval lit = lit_part(light, point);
      about_last.emplace(About{point, {}});
      if (!lit.empty()) about_last->sampling.emplace(record, ray, point.position, lit);
    }
    return about_last->sampling;
  }

  /// sigma_s T L_scattered at a point of the ray, whose shadow is left to be seen: the integrand of single scattering
  /// over the densities of the light direction, times `factor`, which holds what divides it.
  void carry(const Light& light, const IncomingLight& in, const RayPoint<C>& at, DistanceTechnique drawn_by,
             float factor, const LightNumbers& numbers, int k) const {
    Color carried = beta * in.scattered * factor;
    for (int c = 0; c < 3; ++c) {
      const int channel = C == 1 ? 0 : c;
      carried[c] *= at.sigma_s[channel] * at.transmittance[channel];
    }
    if (is_black(carried)) return;
    context.note(bounce, ray.at(at.t), drawn_by, carried);
    shadows.add(light, {ray.at(at.t), in.wi, {0, in.distance}}, carried, numbers, k);
  }

  PhaseMixture<C> phase_at(const RayPoint<C>& at) const {
    return {context.scene, ray.direction, record, at.segment, context.arena};
  }

  /// The same where the record knows another place of the segment only: looked up anew.
  PhaseMixture<C> phase_between(RayPoint<C>& at) const {
    const Scene& scene = context.scene;
    const Collision<C> there =
        collision_at<C>(scene.media, ray, at.t, scene.render.time, context.arena, context.statistics.march);
    at.sigma_s = there.sigma_s;
    return {scene, ray.direction, there.densities};
  }

  Interval lit_part(const Light& light, const LightPoint& point) const {
    return brume::lit_part(record, ray, light, point);
  }

  /// One light sample at a distance that was drawn without regard to the point. A sample is a distance and a direction;
  /// in MIS equi-angular sampling might have drawn both.
  /// @param factor  one over the samples of this technique, on average over the passes
  void at_distance(const SampledPoint<C>& drawn, const Light& light, const LightPoint& point, float factor,
                   const LightNumbers& numbers, int k, DistanceTechnique drawn_by, bool combined) const {
    const auto& [at, pdf] = drawn;
    if (!(pdf > 0)) return;
    const ArenaScope scope(context.arena);
    const LightTechnique<C> technique(light, context, bounce, numbers.index(k));
    const IncomingLight in = technique.draw(point, ray.at(at.t), phase_at(at));
    if (is_black(in.scattered)) return;
    float weight = 1;
    if (combined) {
      const auto& equiangular = about(light, in.point);
      const float other = equiangular ? equiangular->pdf(at) : 0;
      weight = mis_weight(context.scene.render.mis_heuristic, pdf * in.pdf_ratio, other);
    }
    carry(light, in, at, drawn_by, factor * weight / pdf, numbers, k);
  }

  /// @param u  of the distance
  void by_equiangular(const Light& light, const LightPoint& point, float u, float factor, const LightNumbers& numbers,
                      int k, bool combined) const {
    const auto& equiangular = about(light, point);
    if (!equiangular) return;
    const ArenaScope scope(context.arena);
    auto [at, pdf] = equiangular->sample(u);
    if (!(pdf > 0)) return;
    const LightTechnique<C> technique(light, context, bounce, numbers.index(k));
    const PhaseMixture<C> phase = equiangular->is_between(at) ? phase_between(at) : phase_at(at);
    const IncomingLight in = technique.towards(point, ray.at(at.t), phase);
    if (is_black(in.scattered)) return;
    const float weight =
        combined ? mis_weight(context.scene.render.mis_heuristic, pdf, density.pdf(at) * in.pdf_ratio) : 1;
    carry(light, in, at, DistanceTechnique::Equiangular, factor * weight / pdf, numbers, k);
  }

  void by_product(const Light& light, const LightPivot& pivot, float weight, const LightNumbers& numbers) const {
    const ArenaScope scope(context.arena);
    const ProductSampling<C> product = product_with(light, pivot);
    if (!(product.total() > 0)) return;
    const int samples = numbers.count();
    const auto u = numbers.distances(Decision::DensityDistance);
    for (int k = 0; k < samples; ++k) {
      at_distance(product.sample(u(k, samples)), light, light.sample_point(numbers.point(k)),
                  weight / static_cast<float>(samples), numbers, k, DistanceTechnique::Product, false);
    }
  }

  ProductSampling<C> product_with(const Light& light, const LightPivot& pivot) const {
    return product_sampling(record, ray, context.scene, light, pivot, context.arena);
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
    about_last.reset();
    const LightPoint::Kind kind = light.sample_point(numbers.point(0)).kind;  // all points of a light are of one kind
    const bool distant = kind != LightPoint::Kind::Finite;
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
      const bool from_everywhere = kind == LightPoint::Kind::Environment;
      const DensitySampling<C> places(record, from_everywhere ? PlaceInSegment::Drawn : PlaceInSegment::LookedUp);
      const auto u = numbers.distances(Decision::DensityDistance);
      for (int k = 0; k < of_density; ++k) {
        at_distance(places.sample(u(k, of_density)), light, light.sample_point(numbers.point(k)), share, numbers, k,
                    DistanceTechnique::Density, combined);
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
Interval lit_part(const MarchRecord<C>& record, const Ray& ray, const Light& light, const LightPoint& point) {
  return intersect(record.span(), light.lit_part(point, {ray.origin, ray.direction, record.span()}));
}

template <int C>
ProductSampling<C> product_sampling(const MarchRecord<C>& record, const Ray& ray, const Scene& scene,
                                    const Light& light, const LightPivot& pivot, Arena& arena) {
  const LightPoint middle{LightPoint::Kind::Finite, pivot.position, {}, pivot.normal};
  const bool has_one_lit_part = pivot.normal != Vec3() || pivot.radius == 0;
  return {record,
          ray,
          pivot,
          has_one_lit_part ? lit_part(record, ray, light, middle) : record.span(),
          scene.phases.size() == 1 ? scene.phases[0].get() : nullptr,
          arena};
}

template <int C>
void direct_light(const MarchRecord<C>& record, const Ray& ray, Color beta, int bounce, int samples,
                  SampleContext& context, MarchedShadows<C>& shadows) {
  const LightSampling<C> sampling{record, ray, beta, bounce, context, shadows};
  if (sampling.picks_by_product()) return sampling.from_picked_light(samples);
  for_lights(bounce, 0, samples, context, [&](const Light& light, float weight, const LightNumbers& numbers) {
    sampling.from_light(light, weight, numbers);
  });
}

template Interval lit_part(const MarchRecord<1>&, const Ray&, const Light&, const LightPoint&);
template Interval lit_part(const MarchRecord<3>&, const Ray&, const Light&, const LightPoint&);
template ProductSampling<1> product_sampling(const MarchRecord<1>&, const Ray&, const Scene&, const Light&,
                                             const LightPivot&, Arena&);
template ProductSampling<3> product_sampling(const MarchRecord<3>&, const Ray&, const Scene&, const Light&,
                                             const LightPivot&, Arena&);
template void direct_light<1>(const MarchRecord<1>&, const Ray&, Color, int, int, SampleContext&, MarchedShadows<1>&);
template void direct_light<3>(const MarchRecord<3>&, const Ray&, Color, int, int, SampleContext&, MarchedShadows<3>&);

}  // namespace brume
