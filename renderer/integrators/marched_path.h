// Steps of a path on the record of a marched ray, shared by the integrators that march.
#pragma once

#include "renderer/integrators/integrator.h"
#include "renderer/march/density_sampling.h"

namespace brume {

/// First step: the ray's medium written down, with what this scene needs of it.
template <int C> MarchRecord<C> record_ray(const Ray& ray, const MarchSettings& settings, SampleContext& context);

/// Transmittance of a shadow ray, marched at the shadow step.
/// @param index  of its light sample, for the random offset
template <int C> Spectrum<C> marched_shadow(const Ray& shadow, int bounce, int index, SampleContext& context);

/// For light_at_point(): transmittance towards a light by marched_shadow().
template <int C> auto shadow_by_marching(int bounce, SampleContext& context) {
  return [bounce, &context](const Light&, const Ray& shadow, int index) {
    return to_color(marched_shadow<C>(shadow, bounce, index, context));
  };
}

/// Transmittance from the ray's origin to t, read off the record.
template <int C> Spectrum<C> transmittance_to(const MarchRecord<C>& record, float t);

/// Light that the surface behind the record sends through it to the ray's origin, with marched shadow rays.
/// @param place  see for_lights()
template <int C>
Color marched_reflection(const MarchRecord<C>& record, const SurfaceHit& surface, int bounce, int place,
                         SampleContext& context);

/// What probes and the medium's diagnosis want to know.
template <int C> void diagnose(const MarchRecord<C>& record, RayDiagnostics& out);

/// Draws where the path goes on and in which direction: in the medium, at a distance by density sampling, or at the
/// surface that closes the ray, each as often as it has a share in what it sends back; the direction by
/// scatter_direction(). Replaces the ray and multiplies beta.
/// @param record  distributed where it is not empty
/// @return false when the path ends
template <int C>
bool scatter(const MarchRecord<C>& record, const std::optional<SurfaceHit>& surface, Ray& ray, Color& beta, int bounce,
             SampleContext& context);

}  // namespace brume
