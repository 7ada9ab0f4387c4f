// Distances drawn in proportion to what the medium scatters.
#pragma once

#include "renderer/march/march_record.h"

namespace brume {

/// The state of the ray at a distance t, read off the record in O(log n).
template <int C> struct RayPoint {
  float t;
  int segment;
  Spectrum<C> sigma_s;
  Spectrum<C> transmittance;  ///< from the start of the record
};

/// The segment that holds t, by binary search.  @param t  inside record.span()
template <int C> int find_segment(const MarchRecord<C>& record, float t);

template <int C> RayPoint<C> evaluate(const MarchRecord<C>& record, float t, int segment);

template <int C> RayPoint<C> evaluate(const MarchRecord<C>& record, float t) {
  return evaluate(record, t, find_segment(record, t));
}

/// A segment drawn in proportion to its part of a running sum, and what is left of the number that drew it, in [0, 1].
struct DrawnSegment {
  int segment;
  float rest;
};

/// By binary search.  @param cdf  [n + 1], not normalised, cdf[n] > 0.  @param u  in [0,1)
DrawnSegment draw_segment(const float* cdf, int n, float u);

/// Density sampling: pdf(t) = sum_c weight_c sigma_s_c(t) T_c(t) / sum_i P_i, normalised over the record.
/// For one channel the estimator sigma_s T / pdf is then the same number for every t. With several it is the balance
/// heuristic over "draw the distance for channel c" (weights at most 1 / weight_c).
/// Needs record.scattered() > 0.
template <int C> class DensitySampling {
 public:
  explicit DensitySampling(const MarchRecord<C>& record) : record_(record) {}

  /// Segment by binary search in the CDF, then the exponential of that segment inverted.  @param u in [0,1)
  RayPoint<C> sample(float u) const;

  /// The same inside a segment that scatters.  @param v  in [0, 1]
  RayPoint<C> sample_in(int segment, float v) const;

  /// Of any point of the ray, per world unit.
  float pdf(const RayPoint<C>& point) const;

 private:
  const MarchRecord<C>& record_;
};

}  // namespace brume
