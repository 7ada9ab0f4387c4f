// Steps of a path on the record of a marched ray, shared by the integrators that march.
#pragma once

#include "renderer/integrators/integrator.h"
#include "renderer/march/density_sampling.h"

namespace brume {

/// First step: the ray's medium written down, with what this scene needs of it.
template <int C> MarchRecord<C> record_ray(const Ray& ray, const MarchSettings& settings, SampleContext& context);

/// Transmittance from the ray's origin to t, read off the record.
template <int C> Spectrum<C> transmittance_to(const MarchRecord<C>& record, float t);

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
