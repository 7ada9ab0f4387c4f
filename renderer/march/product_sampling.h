// Distances drawn in proportion to what a light does along the ray, but for its shadows.
#pragma once

#include "renderer/core/ray.h"
#include "renderer/lights/light.h"
#include "renderer/march/density_sampling.h"
#include "renderer/march/equiangular_distribution.h"
#include "renderer/phase/phase_function.h"

namespace brume {

/// Product sampling: segment i is drawn with the weight
///   w_i = P_i / delta_i * (integral over the segment of 1/r^2) * phase * cosine at the light,
/// which is scattering times transmittance times what arrives unshadowed; the phase function is a mean over the edges,
/// the cosine that of the middle of the segment. Inside the segment the distance is equi-angular where 1/r^2 varies
/// most, next to the light, and as in density sampling elsewhere. What is left to vary is the shadow; one sample in a
/// hundred is drawn by the integral of 1/r^2 alone, for media so dense that shadows are everything. Brume's own
/// addition to the techniques of Kulla & Fajardo 2012, who draw in proportion to one factor or the other.
template <int C> class ProductSampling {
 public:
  /// Everything lives in the arena scope that is open.
  /// @param record  distributed, with scattered() > 0.  @param p  [n] its scattered_by_segment(), which is kept
  /// @param lit  the part of the ray that the light can reach.  @param phase  null: taken as the same all around
  ProductSampling(const MarchRecord<C>& record, const float* p, const Ray& ray, const LightPivot& pivot, Interval lit,
                  const PhaseFunction* phase, Arena& arena);

  /// Sum of the products: the light that the ray scatters to its origin, unshadowed, for a light of unit intensity.
  float total() const;

  /// Needs total() > 0.  @param u  in [0,1)
  SampledPoint<C> sample(float u) const { return place(draw(u)); }

  /// The same in two steps, as DensitySampling.
  DrawnSegment draw(float u) const { return draw_segment(cdf_, record_.n, u); }
  SampledPoint<C> place(DrawnSegment drawn) const;

  /// As in DensitySampling.
  bool is_looked_up(int segment) const { return density_.is_looked_up(segment) && !is_near(segment); }
  float probability(int segment) const { return (cdf_[segment + 1] - cdf_[segment]) / cdf_[record_.n]; }

 private:
  bool is_near(int segment) const { return foot_.is_near(record_.segment(segment)); }

  const MarchRecord<C>& record_;
  const float* p_;
  DensitySampling<C> density_;
  Interval lit_;
  PivotFoot foot_;    // no nearer than the pivot's radius
  const float* cdf_;  // [n + 1]
};

}  // namespace brume
