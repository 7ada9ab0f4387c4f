// First step of the decoupled march: the medium along a ray, written down once.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "renderer/core/arena.h"
#include "renderer/core/spectrum.h"
#include "renderer/march/attenuation.h"
#include "renderer/media/medium.h"

namespace brume {

/// What marching has cost so far.
struct MarchCounts {
  std::uint64_t lookups = 0;   ///< points asked of shaders
  std::uint64_t segments = 0;  ///< recorded on camera and scattered rays
  std::uint64_t capped = 0;    ///< stretches whose step was raised to stay within kMaxSegments, and rays whose majorant
                               ///< was lowered to stay within kMaxFlights
  std::uint64_t exceeded = 0;  ///< tentative collisions where there was more than the majorant
};

struct MarchSettings {
  float step;                      ///< world units, > 0
  float offset;                    ///< in [0,1): where inside every segment of this ray the medium is looked up
  float time;                      ///< seconds
  bool split_homogeneous = false;  ///< step through homogeneous stretches too, where every step counts for the lighting
};

/// A stretch of medium with more steps than this is marched with a longer step, and counted: the volume never ends in
/// mid-air.
inline constexpr int kMaxSegments = 1 << 16;

/// The ray's medium as n segments in which every coefficient is constant. Arrays live in the arena of the scope that
/// was open when record() was called.
///
/// The first block is written by record(), the second by distribute().
template <int C> struct MarchRecord {
  int n = 0;                              ///< segments; 0 when the ray meets no medium
  const float* t = nullptr;               ///< [n + 1] edges, ascending, world units; stretches of empty space count
  std::array<Coefficient, C> sigma_t;     ///< per world unit; of the only medium of a ray all share its density
  std::array<Coefficient, C> sigma_s;     ///< the same
  const Coefficient* emission = nullptr;  ///< [3] W/(sr m^3); null where no medium emits
  const float* const* medium_density = nullptr;  ///< [media][n]; null unless several media may share a point
  bool* homogeneous = nullptr;  ///< [n] nothing varies inside the segment; null where all segments vary
  float offset = 0;             ///< in [0,1): where inside every other segment the medium was looked up

  float longest = 0;       ///< bound of the segments' lengths
  float inverse_step = 0;  ///< of segments that are as long as each other, but for the last; 0: they are not

  std::array<const float*, C> tau = {};            ///< [n + 1] optical depth from t[0] to each edge
  std::array<const float*, C> transmittance = {};  ///< [n + 1] exp(-tau)
  const float* p = nullptr;                        ///< [n] P_i; null where the albedo is one, and the CDF needs none
  const float* cdf = nullptr;                      ///< [n + 1] running sum of the P_i, not normalised
  Spectrum<C> weight = {};                         ///< of the channels in P_i

  bool empty() const { return n == 0; }
  Interval span() const { return {t[0], t[n]}; }
  Segments segments() const { return {t, n, inverse_step > 0 ? longest : 0}; }
  Interval segment(int i) const { return {t[i], t[i + 1]}; }
  /// How far behind its begin a segment that varies was looked up.
  float looked_up_behind(int i) const { return offset * segment(i).length(); }
  bool is_homogeneous(int i) const { return homogeneous && homogeneous[i]; }
  /// Nothing scatters in the segment.
  bool is_clear(int i) const {
    return std::all_of(sigma_s.begin(), sigma_s.end(), [i](const Coefficient& sigma) { return sigma[i] == 0; });
  }
  /// One and the same albedo everywhere, in each channel.
  bool has_one_albedo() const { return sigma_s[0].amount == sigma_t[0].amount; }

  /// Sum of all P_i: the part of the light that scatters once along the ray, averaged over the channels.
  float scattered() const { return cdf[n]; }
  /// P_i / sum P, as density sampling draws it.
  float probability(int i) const { return (cdf[i + 1] - cdf[i]) / cdf[n]; }
};

/// What a record of this scene must hold.
struct RecordContents {
  bool emission = false;
  bool overlap = false;  ///< keep each medium's density, to mix their phase functions
};

/// Splits the ray's stretches of medium into segments with fixed edges at begin + i * step (the last one shorter; one
/// segment where the medium is homogeneous) and looks every segment up once, at begin + (i + offset) * step. The offset
/// is the ray's only random number: one per ray and not one per step, because the exponential of a noisy optical depth
/// is too bright on average, and independent steps make it noisier.
/// Unbiased where segments are homogeneous; otherwise biased by what the medium varies inside a step.
/// Kulla 2011, "Decoupled Ray-marching of Heterogeneous Participating Media".
template <int C>
MarchRecord<C> record(std::span<const Medium> media, const RecordContents& contents, const Ray& ray,
                      const MarchSettings& settings, Arena& arena, MarchCounts& counts);

/// Parts of a stretch of `length` when marched at `step`, at most kMaxSegments.
int segment_count(float length, float& step, MarchCounts& counts);

}  // namespace brume
