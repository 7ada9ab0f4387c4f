// Distances on a marched ray drawn in proportion to 1/r^2 from a point of a light.
#pragma once

#include "renderer/march/equiangular_distribution.h"
#include "renderer/march/ray_point.h"

namespace brume {

/// Equi-angular sampling of a record: EquiangularDistribution chooses the segment. Where that one is homogeneous, or so
/// near to the pivot that 1/r^2 varies in it, the distance is the distribution's, too, and what scatters there is to be
/// looked up; elsewhere it is the place where the segment was looked up (PlaceInSegment::LookedUp), with the mean of
/// the distribution's density over the segment.
template <int C> class EquiangularSampling {
 public:
  /// @param lit  the part of the record that is sampled, not empty
  EquiangularSampling(const MarchRecord<C>& record, const Ray& ray, Vec3 pivot, Interval lit)
      : EquiangularSampling(record, EquiangularDistribution(ray, pivot, lit), lit) {}

  EquiangularSampling(const MarchRecord<C>& record, const EquiangularDistribution& distribution, Interval lit)
      : record_(record), distribution_(distribution), lit_(lit) {}

  /// A point of density 0 lies on the border of the lit part: of no use.  @param u  in [0,1)
  SampledPoint<C> sample(float u) const {
    const DistanceSample drawn = distribution_.sample(u);
    const int segment = find_segment(record_, drawn.t);
    if (follows(segment)) return {evaluate(record_, drawn.t, segment), drawn.pdf_t};
    return {looked_up_point(record_, segment), mean_pdf(segment)};
  }

  /// Whether the record knows another place of the segment only.
  bool is_between(const RayPoint<C>& point) const {
    return follows(point.segment) && !record_.homogeneous[point.segment];
  }

  /// Of any point of the ray, per world unit.
  float pdf(const RayPoint<C>& point) const {
    return follows(point.segment) ? distribution_.pdf(point.t) : mean_pdf(point.segment);
  }

 private:
  Interval segment_span(int i) const { return {record_.t[i], record_.t[i + 1]}; }

  bool follows(int segment) const {
    return record_.homogeneous[segment] || distribution_.foot().is_near(segment_span(segment));
  }

  float mean_pdf(int segment) const {
    const Interval span = segment_span(segment), part = intersect(span, lit_);
    return part.empty() ? 0 : distribution_.probability(part) / span.length();
  }

  const MarchRecord<C>& record_;
  EquiangularDistribution distribution_;
  Interval lit_;
};

}  // namespace brume
