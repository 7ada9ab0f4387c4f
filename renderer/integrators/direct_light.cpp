#include "renderer/integrators/direct_light.h"

#include "renderer/integrators/light_batch.h"
#include "renderer/integrators/path.h"
#include "renderer/march/distribute.h"

namespace brume {
namespace {

template <int C> struct LightSampling {
  const MarchRecord<C>& record;
  const Ray& ray;
  int bounce;
  SampleContext& context;
  LightBatch<C>& batch;
  const float* p;  // P_i of the segments, where product sampling needs them

  ProductSampling<C> product_with(const Light& light, const LightPivot& pivot) const {
    return product_sampling(record, p, ray, context.scene, light, pivot, context.arena);
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
    const LightPoint::Kind kind = light.kind();
    const bool distant = kind != LightPoint::Kind::Finite;
    const bool combined = mode == DistanceSampling::Mis && !distant;
    int of_density = mode == DistanceSampling::Equiangular && !distant ? 0 : samples;
    if (combined) {
      // Half of the samples to each technique; of an odd number the odd one alternates between passes, starting with
      // either at random, so that every single pass is unbiased over the pixels.
      of_density = samples / 2;
      if (samples % 2 != 0 &&
          (context.sampler.sample() % 2 != 0) != (context.sampler.per_pixel(Decision::TechniquePhase) < 0.5f))
        ++of_density;
    }
    const float share = (combined ? 2 : 1) * weight / static_cast<float>(samples);
    // Strata: as many as the technique has samples in this very pass, or they would not cover [0,1) just once.
    if (of_density > 0) {
      const bool from_everywhere = kind == LightPoint::Kind::Environment;
      const DensitySampling<C> places(record, from_everywhere ? PlaceInSegment::Drawn : PlaceInSegment::LookedUp);
      const auto u = numbers.distances(Decision::DensityDistance);
      batch.add_at({light, DistanceTechnique::Density, share, combined}, places, numbers, u, of_density);
    }
    const int about_light = samples - of_density;
    if (about_light > 0) {
      const auto u = numbers.distances(Decision::EquiangularDistance);
      batch.add_about({light, DistanceTechnique::Equiangular, share, combined}, numbers, u, of_density, about_light);
    }
  }

  void by_product(const Light& light, const LightPivot& pivot, float weight, const LightNumbers& numbers) const {
    const ArenaScope scope(context.arena);
    const ProductSampling<C> product = product_with(light, pivot);
    if (!(product.total() > 0)) return;
    const int samples = numbers.count();
    const auto u = numbers.distances(Decision::DensityDistance);
    batch.add_at({light, DistanceTechnique::Product, weight / static_cast<float>(samples), false}, product, numbers, u,
                 samples);
  }
};

}  // namespace

template <int C>
ProductSampling<C> product_sampling(const MarchRecord<C>& record, const float* p, const Ray& ray, const Scene& scene,
                                    const Light& light, const LightPivot& pivot, Arena& arena) {
  const LightPoint middle{.position = pivot.position, .normal = pivot.normal};
  const bool has_one_lit_part = pivot.normal != Vec3() || pivot.radius == 0;
  return {record,
          p,
          ray,
          pivot,
          has_one_lit_part ? lit_part(record, ray, light, middle) : record.span(),
          scene.phases.size() == 1 ? scene.phases[0].get() : nullptr,
          arena};
}

template <int C>
void direct_light(const MarchRecord<C>& record, const Ray& ray, Color beta, int bounce, int samples,
                  SampleContext& context, MarchedShadows<C>& shadows) {
  LightBatch<C> batch(record, ray, beta, bounce, context, shadows);
  const float* const p = context.scene.needs.product ? scattered_by_segment(record, context.arena) : nullptr;
  const LightSampling<C> sampling{record, ray, bounce, context, batch, p};
  if (sampling.picks_by_product()) {
    sampling.from_picked_light(samples);
  } else {
    for_lights(bounce, 0, samples, context, [&](const Light& light, float weight, const LightNumbers& numbers) {
      sampling.from_light(light, weight, numbers);
    });
  }
  batch.finish();
}

template ProductSampling<1> product_sampling(const MarchRecord<1>&, const float*, const Ray&, const Scene&,
                                             const Light&, const LightPivot&, Arena&);
template ProductSampling<3> product_sampling(const MarchRecord<3>&, const float*, const Ray&, const Scene&,
                                             const Light&, const LightPivot&, Arena&);
template void direct_light<1>(const MarchRecord<1>&, const Ray&, Color, int, int, SampleContext&, MarchedShadows<1>&);
template void direct_light<3>(const MarchRecord<3>&, const Ray&, Color, int, int, SampleContext&, MarchedShadows<3>&);

}  // namespace brume
