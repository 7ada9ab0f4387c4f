// What light samples of one ray count, at SIMD width.
#pragma once

#include "renderer/lights/light_lanes.h"
#include "renderer/scene/settings.h"

namespace brume {

/// A light sample in each lane: how it was drawn, and what the ray scatters there.
template <int C> struct LightWeights {
  LaneArray<float> factor;  ///< one over the samples of the lane's technique, on average over the passes
  /// The densities of the distance, per world unit, by equi-angular sampling about the point of the light and by the
  /// technique that knows nothing of it.
  LaneArray<float> equiangular, unaimed;
  LaneArray<float> pdf_ratio;     ///< as in IncomingLight: the direction's density over that of the point
  LaneArray<std::int32_t> drawn;  ///< the bits below

  LaneArray<float> phase;         ///< 1/sr
  LaneArray<float> scattered[C];  ///< sigma_s T, with T up to somewhere before
  LaneArray<float> left[C];       ///< what is left of the light from there on: the rest of T

  LaneArray<float> carried[3];  ///< what comes of it: radiance if nothing is in the shadow ray's way

  static constexpr std::int32_t kAbout = 1;     ///< by equi-angular sampling
  static constexpr std::int32_t kCombined = 2;  ///< the other of the two might have drawn the same place and direction
};

/// For each lane below n
///   carried = beta * scattered left * phase * irradiance * factor * weight / pdf,
/// with the pdf of the technique that drew it and the weight of the heuristic where two are combined; 0 where the pdf
/// is.
/// @param beta  throughput of the path up to the ray
template <int C>
void carry(LightWeights<C>& lanes, const LightLanes& lights, Color beta, MisHeuristic heuristic, int n);

}  // namespace brume
