// Transmittance towards a light.
#pragma once

#include "renderer/march/attenuation.h"
#include "renderer/march/march_record.h"
#include "renderer/march/shadow_rays.h"

namespace brume {

/// Optical depths along rays, marched like record() (fixed edges, one offset per ray), but only summed: optical depths
/// of overlapping media add, so no medium needs to know of another. Rays that are marched together share the look-ups
/// of their media, which are cheaper by the dozen; what a ray gets does not depend on the others.
/// @param step  world units.  @param time  seconds.  @param depths  [rays.n]
template <int C>
void shadow_optical_depths(std::span<const Medium> media, const ShadowRays& rays, float step, float time, Arena& arena,
                           MarchCounts& counts, Spectrum<C>* depths);

/// exp(-optical depth): one exponential per channel and ray.
template <int C>
void shadow_transmittances(std::span<const Medium> media, const ShadowRays& rays, float step, float time, Arena& arena,
                           MarchCounts& counts, Spectrum<C>* transmittances) {
  shadow_optical_depths<C>(media, rays, step, time, arena, counts, transmittances);
  static_assert(sizeof(Spectrum<C>) == C * sizeof(float));
  if (rays.n > 0) exp_minus(transmittances[0].v, C * rays.n);
}

/// The same for a single ray.
template <int C>
Spectrum<C> shadow_optical_depth(std::span<const Medium> media, const Ray& ray, const MarchSettings& settings,
                                 Arena& arena, MarchCounts& counts) {
  const ArenaScope scope(arena);
  ShadowRays one(1, arena);
  one.add(ray, settings.offset);
  Spectrum<C> depth;
  shadow_optical_depths<C>(media, one, settings.step, settings.time, arena, counts, &depth);
  return depth;
}

template <int C>
Spectrum<C> shadow_transmittance(std::span<const Medium> media, const Ray& ray, const MarchSettings& settings,
                                 Arena& arena, MarchCounts& counts) {
  Spectrum<C> result = shadow_optical_depth<C>(media, ray, settings, arena, counts);
  for (float& v : result.v) v = std::exp(-v);
  return result;
}

}  // namespace brume
