// What the paths of all integrators have in common.
#pragma once

#include "renderer/integrators/incoming_light.h"
#include "renderer/integrators/integrator.h"
#include "renderer/sampling/light_numbers.h"

namespace brume {

/// Russian roulette on a path of throughput beta (f over pdf). Begins late and never below a twentieth: earlier or
/// rarer survival trades noise for fireflies.
/// @return the factor of what survives; 0 ends the path
float roulette(Color beta, int bounce, const SampleContext& context);

/// The channel that leads a tracked path: drawn where there are several, each with the same probability.
template <int C> int leading_channel(const Sampler& sampler) {
  return C == 1 ? 0 : std::min(static_cast<int>(C * sampler.u1(Decision::Channel)), C - 1);
}

/// The surface that closes the ray, which from then on ends there; nothing where there is none.
inline std::optional<SurfaceHit> close(Ray& ray, const Scene& scene) {
  if (!scene.surfaces) return std::nullopt;
  const auto surface = scene.surfaces->intersect(ray);
  if (surface) ray.span.end = surface->t;
  return surface;
}

/// What the camera sees of the lights themselves, and of a surface that glows. Lamps do not block.
/// @param ray  closed by `surface`.  @param transmittance  Color(distance), of the medium in front
template <class Transmittance>
Color visible_lights(const Scene& scene, const Ray& ray, const std::optional<SurfaceHit>& surface,
                     const Transmittance& transmittance) {
  Color sum;
  for (const auto& light : scene.lights) {
    if (!light->visible_to_camera) continue;
    if (const auto hit = light->hit(ray)) sum += hit->radiance * transmittance(hit->t);
  }
  if (surface && !is_black(surface->emitted)) sum += surface->emitted * transmittance(surface->t);
  return sum;
}

/// Calls f(light, weight, numbers of its samples) for every light, or for one that is picked, which then counts as
/// often as there are lights.
/// @param place  of the point among those of its ray, for the random numbers.  @param samples  of each light
template <class F> void for_lights(int bounce, int place, int samples, const SampleContext& context, const F& f) {
  const Scene& scene = context.scene;
  const int lights = static_cast<int>(scene.lights.size());
  if (scene.render.light_selection == LightSelection::One && lights > 1) {
    const float u = context.sampler.u1(Decision::LightChoice, bounce, place);
    const int chosen = std::min(static_cast<int>(u * static_cast<float>(lights)), lights - 1);
    f(*scene.lights[static_cast<std::size_t>(chosen)], static_cast<float>(lights),
      LightNumbers(context.sampler, bounce, place, samples));
    return;
  }
  for (int l = 0; l < lights; ++l)
    f(*scene.lights[static_cast<std::size_t>(l)], 1.0f,
      LightNumbers(context.sampler, bounce, place * lights + l, samples));
}

/// Calls f(light, factor, numbers, k) for `samples` samples of each of those lights. The factors are those of a mean
/// over the samples.
template <class F>
void for_light_samples(int bounce, int place, int samples, const SampleContext& context, const F& f) {
  for_lights(bounce, place, samples, context, [&](const Light& light, float weight, const LightNumbers& numbers) {
    for (int k = 0; k < samples; ++k) f(light, weight / static_cast<float>(samples), numbers, k);
  });
}

/// One sample of the light that a vertex of a path scatters once towards where the path comes from: factor * value * L,
/// handed to the shadows, which multiply it by the transmittance of its shadow ray.
/// @param shadows  MarchedShadows or TrackedShadows: add(light, shadow ray, carried, its numbers)
template <int C, Scatterer<C> S, class Shadows>
void light_sample_at(Vec3 x, const S& scatterer, Color factor, const Light& light, const LightNumbers& numbers,
                     int bounce, int k, SampleContext& context, Shadows& shadows) {
  LightPoint point = light.sample_point(numbers.point(k));
  const IncomingLight in = LightTechnique<C>(light, context, bounce, numbers.index(k)).draw(point, x, scatterer);
  if (is_black(in.scattered)) return;
  context.note(bounce, x, DistanceTechnique::Other, factor * in.scattered);
  shadows.add(light, Ray{x, in.wi, {0, in.distance}}, factor * in.scattered, numbers.of_shadow(k));
}

/// Light that a vertex of a path scatters once towards where the path comes from: the mean over the light samples of
/// factor * value * L.
template <int C, Scatterer<C> S, class Shadows>
void light_at_point(Vec3 x, const S& scatterer, Color factor, int bounce, int place, int samples,
                    SampleContext& context, Shadows& shadows) {
  for_light_samples(bounce, place, samples, context,
                    [&](const Light& light, float weight, const LightNumbers& numbers, int k) {
                      light_sample_at<C>(x, scatterer, factor * weight, light, numbers, bounce, k, context, shadows);
                    });
}

/// The same for the surface that closes a ray.
template <int C, class Shadows>
void light_at_surface(const SurfaceHit& surface, Color factor, int bounce, int place, int samples,
                      SampleContext& context, Shadows& shadows) {
  if (is_black(surface.albedo)) return;
  light_at_point<C>(surface.position, DiffuseReflection<C>(surface.normal, surface.albedo), factor, bounce, place,
                    samples, context, shadows);
}

}  // namespace brume
