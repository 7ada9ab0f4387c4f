// Distances drawn in proportion to what the medium scatters.
#pragma once

#include "renderer/march/ray_point.h"

namespace brume {

/// A segment drawn in proportion to its part of a running sum, and what is left of the number that drew it, in [0, 1].
struct DrawnSegment {
  int segment;
  float rest;
};

/// By binary search.  @param cdf  [n + 1], not normalised, cdf[n] > 0.  @param u  in [0,1)
DrawnSegment draw_segment(const float* cdf, int n, float u);

/// Where in a segment that varies a distance is put.
enum class PlaceInSegment {
  /// By the exponential, as if the segment were homogeneous: what is scattered and what is let through add up to 1 on
  /// every ray, so paths and the light of an environment, which comes from everywhere, neither gain nor lose energy.
  Drawn,
  /// Where it was looked up. Over the passes the place is uniform in the segment, and what scatters goes with the light
  /// that arrives there. Drawn anew, the place knows nothing of the coefficient; the medium and the light of a lamp,
  /// which vary together inside a step because of the shadows, are averaged apart: half a percent too bright at steps
  /// of a voxel, five in dense smoke.
  LookedUp,
};

/// Density sampling: segment i is drawn with probability P_i / sum P. Where it is homogeneous, or places are drawn, the
/// distance has
///   pdf(t) = sum_c weight_c sigma_s_c(t) T_c(t) / sum P,
/// and for one channel the estimator sigma_s T / pdf is then the same number for every t; with several it is the
/// balance heuristic over "draw the distance for channel c" (weights at most 1 / weight_c). Elsewhere it is the place
/// where the segment was looked up, with pdf(t) = P_i / (delta_i sum P). Both are exact where the medium is constant in
/// every segment. Needs record.scattered() > 0.
template <int C> class DensitySampling {
 public:
  DensitySampling(const MarchRecord<C>& record, PlaceInSegment place) : record_(record), place_(place) {}

  /// Segment by binary search in the CDF, then the place in it.  @param u in [0,1)
  SampledPoint<C> sample(float u) const { return place(draw(u)); }

  /// The same in two steps: who draws many makes each step for all of them.
  DrawnSegment draw(float u) const { return draw_segment(record_.cdf, record_.n, u); }
  SampledPoint<C> place(DrawnSegment drawn) const;

  /// Whether the place in the segment is the one where it was looked up, with pdf(t) = probability / length.
  bool is_looked_up(int segment) const { return !is_drawn(segment); }
  float probability(int segment) const { return record_.probability(segment); }

  /// The same inside a segment that scatters and was drawn by other means.  @param v  in [0, 1]
  /// @param p  P_i of the segment.  @param probability  with which it was drawn
  SampledPoint<C> sample_in(int segment, float v, float p, float probability) const;

  /// Of any point of the ray, per world unit.
  float pdf(const RayPoint<C>& point) const;

 private:
  bool is_drawn(int segment) const { return place_ == PlaceInSegment::Drawn || record_.is_homogeneous(segment); }
  RayPoint<C> place_in(int segment, float v) const;
  RayPoint<C> exponential(int segment, float v) const;
  float scattered_at(const RayPoint<C>& point) const;

  const MarchRecord<C>& record_;
  PlaceInSegment place_;
};

}  // namespace brume
