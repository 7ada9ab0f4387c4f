// Transmittance towards a light.
#pragma once

#include "renderer/march/march_record.h"

namespace brume {

/// Optical depth along ray.span, marched like record() (fixed edges, one shared offset), but only summed: optical
/// depths of overlapping media add, so no medium needs to know of another.
template <int C>
Spectrum<C> shadow_optical_depth(std::span<const Medium> media, const Ray& ray, const MarchSettings& settings,
                                 Arena& arena, MarchCounts& counts);

/// exp(-optical depth): one exponential per channel and ray.
template <int C>
Spectrum<C> shadow_transmittance(std::span<const Medium> media, const Ray& ray, const MarchSettings& settings,
                                 Arena& arena, MarchCounts& counts) {
  Spectrum<C> result = shadow_optical_depth<C>(media, ray, settings, arena, counts);
  for (float& v : result.v) v = std::exp(-v);
  return result;
}

}  // namespace brume
