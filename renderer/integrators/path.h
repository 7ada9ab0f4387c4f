// What the paths of all integrators have in common.
#pragma once

#include "renderer/integrators/incoming_light.h"
#include "renderer/integrators/integrator.h"

namespace brume {

/// Russian roulette on a path of throughput beta (f over pdf). Begins late and never below a twentieth: earlier or
/// rarer survival trades noise for fireflies.
/// @return the factor of what survives; 0 ends the path
float roulette(Color beta, int bounce, const SampleContext& context);

/// What the camera sees of the lights themselves. Lamps do not block.
/// @param transmittance  Color(distance), of the medium in front
template <class Transmittance>
Color visible_lights(const Scene& scene, const Ray& ray, const Transmittance& transmittance) {
  Color sum;
  for (const auto& light : scene.lights) {
    if (!light->visible_to_camera) continue;
    if (const auto hit = light->hit(ray)) sum += hit->radiance * transmittance(hit->t);
  }
  return sum;
}

/// Calls f(light, factor, index) for `samples` samples of every light, or of one that is picked, whose samples then
/// count as often as there are lights. The factors are those of a mean over the samples.
/// @param place  of the point among those of its ray, for the random numbers
template <class F>
void for_light_samples(int bounce, int place, int samples, const SampleContext& context, const F& f) {
  const Scene& scene = context.scene;
  const int lights = static_cast<int>(scene.lights.size());
  const bool one = scene.render.light_selection == LightSelection::One && lights > 1;
  const float u = one ? context.sampler.u1(Decision::LightChoice, bounce, place) : 0;
  const int chosen = std::min(static_cast<int>(u * static_cast<float>(lights)), lights - 1);
  for (int l = one ? chosen : 0; l < (one ? chosen + 1 : lights); ++l)
    for (int k = 0; k < samples; ++k) {
      const int index = (place * (one ? 1 : lights) + (one ? 0 : l)) * samples + k;
      f(*scene.lights[static_cast<std::size_t>(l)],
        (one ? static_cast<float>(lights) : 1.0f) / static_cast<float>(samples), index);
    }
}

/// Light that a point of a ray scatters once towards the ray's origin, times sigma_s: the mean over the light samples
/// of phase * L * transmittance.
/// @param transmittance  Color(light, shadow ray, index)
template <int C, class Transmittance>
Color light_at_point(Vec3 x, Vec3 direction, const PhaseMixture<C>& phase, int bounce, int place, int samples,
                     SampleContext& context, const Transmittance& transmittance) {
  Color sum;
  for_light_samples(bounce, place, samples, context, [&](const Light& light, float factor, int index) {
    const LightPoint point = light.sample_point(context.sampler.u2(Decision::LightPoint, bounce, index));
    const IncomingLight in = LightTechnique<C>(light, context, bounce, index).draw(point, x, direction, phase);
    if (is_black(in.scattered)) return;
    ++context.statistics.shadow_rays;
    sum += in.scattered * transmittance(light, Ray{x, in.wi, {0, in.distance}}, index) * factor;
  });
  return sum;
}

}  // namespace brume
