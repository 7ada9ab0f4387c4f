// Points of a marched ray.
#pragma once

#include "renderer/march/march_record.h"

namespace brume {

/// The state of the ray at a distance t, read off the record.
template <int C> struct RayPoint {
  float t;
  int segment;
  Spectrum<C> sigma_s;
  Spectrum<C> transmittance;  ///< from the start of the record
};

/// The segment that holds t: reckoned where segments are equal, otherwise by binary search in O(log n).  @param t
/// inside record.span()
template <int C> int find_segment(const MarchRecord<C>& record, float t);

template <int C> RayPoint<C> evaluate(const MarchRecord<C>& record, float t, int segment);

template <int C> RayPoint<C> evaluate(const MarchRecord<C>& record, float t) {
  return evaluate(record, t, find_segment(record, t));
}

/// The place where a segment was looked up.
template <int C> RayPoint<C> looked_up_point(const MarchRecord<C>& record, int segment);

/// A point and the density it was drawn with. Functions that draw make it where it is to stay: a copy of what has just
/// been written in pieces waits until they are in the cache.
template <int C> struct SampledPoint {
  RayPoint<C> at;
  float pdf_t;  ///< per world unit
};

/// The segment between two edges that holds a value: the last one that begins at or below it.
/// @param edges  [n + 1], ascending.  @param n  > 0.  @return in [0, n)
int segment_of(const float* edges, int n, float value);

}  // namespace brume
