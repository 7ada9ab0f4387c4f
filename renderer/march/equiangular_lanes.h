// Equi-angular sampling of one ray about many points of lights, at SIMD width.
#pragma once

#include "renderer/core/ray.h"
#include "renderer/core/simd.h"
#include "renderer/march/equiangular_distribution.h"

namespace brume {

/// The equations of EquiangularDistribution for one ray and a pivot in each lane, in single precision. So that nothing
/// is lost to it, distances are measured from the end of the span that is nearer in angle. The one at the angle phi
/// from there is away from that end by
///   sin phi (D^2 + e^2) / (D cos phi - e sin phi),
/// where e is that end's place, from the foot and in the direction of the other end.
class EquiangularLanes {
 public:
  /// @param span  the part of the ray that is sampled, world units. Empty: the density is 0 everywhere, and nothing is
  /// to be sampled
  void aim(int lane, Vec3 pivot, Interval span);

  /// Finds where the pivots are, seen from the ray, and the angles under which they see their spans; to be called when
  /// those lanes below n are aimed that anyone asks for. The functions below are for lanes below n, too.
  void measure(const Ray& ray, int n);

  /// @param u  in [0, 1).  @param t  distances, one for each u
  void sample(const LaneArray<float>& u, LaneArray<float>& t) const;

  /// Mean density over a part of the ray that is far from the lane's pivot, or the density at its begin where the part
  /// has no length; per world unit.
  /// @param begin, end  of the parts
  void pdf(const LaneArray<float>& begin, const LaneArray<float>& end, LaneArray<float>& pdf) const;

  /// Whether 1/r^2 varies within a part of the ray.
  bool is_near(int lane, Interval part) const {
    return PivotFoot{lanes_.foot[lane], lanes_.distance[lane]}.is_near(part);
  }

  /// For the loops over lanes. All lengths in world units.
  struct Arrays {
    int n;
    LaneArray<float> pivot[3];
    LaneArray<float> begin, end;      ///< of the span
    LaneArray<float> foot, distance;  ///< of the pivot, along the ray and from it
    LaneArray<float> a, b;            ///< the span's ends, measured from the foot
    LaneArray<float> angle;           ///< under which the pivot sees the span; 0: uniform
  };

 private:
  Arrays lanes_;
};

}  // namespace brume
