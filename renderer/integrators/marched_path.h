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

/// Transmittance from the ray's origin to t, read off the record.
template <int C> Spectrum<C> transmittance_to(const MarchRecord<C>& record, float t);

/// What probes and the medium's diagnosis want to know.
template <int C> void diagnose(const MarchRecord<C>& record, RayDiagnostics& out);

/// Draws where and in which direction the path goes on: a distance by density sampling, a direction by
/// scatter_direction(). Replaces the ray and multiplies beta.
/// @param record  distributed, with scattered() > 0
/// @return false when the path ends
template <int C> bool scatter(const MarchRecord<C>& record, Ray& ray, Color& beta, int bounce, SampleContext& context);

}  // namespace brume
