// Distances drawn in proportion to 1/r^2 from a point of a light.
#pragma once

#include "renderer/core/ray.h"

namespace brume {

/// A distance along the ray with the density it was drawn with.
struct DistanceSample {
  float t;      ///< world units
  float pdf_t;  ///< per world unit; > 0
};

/// A pivot seen from a ray.
struct PivotFoot {
  double t;         ///< of the point of the ray that is next to it
  double distance;  ///< from there, > 0

  /// Where the pivot is farther from a part of the ray than so many of its lengths, 1/r^2 is taken as constant in it.
  static constexpr float kNear = 6;

  /// Whether 1/r^2 varies within a part of the ray.
  bool is_near(Interval part) const {
    const double reach = static_cast<double>(kNear * part.length());
    return distance < reach && std::abs(0.5 * (static_cast<double>(part.begin) + part.end) - t) < reach;
  }
};

/// A pivot on the ray is taken as if it were away from it by this share of the way to the farther end of the span.
inline constexpr double kLeastPivotDistance = 1e-7;

/// @param span  world units, not empty
PivotFoot foot_of(const Ray& ray, Vec3 pivot, Interval span);

/// Equi-angular sampling of a span of a ray about a pivot: pdf(t) = D / (d_theta (D^2 + s^2)), where s = t - foot is
/// measured from the foot of the pivot on the ray and D is the pivot's distance from the ray.
/// Kulla & Fajardo 2012, "Importance Sampling Techniques for Path Tracing in Participating Media", section 3 (their
/// proceedings print negates exponents in equation 8; the authors' page corrects it; not used here).
///
/// Written without differences of nearly equal angles: with a, b the span's ends measured from the foot,
///   d_theta = atan2(D (b - a), D^2 + a b),
/// and where the foot lies outside the span
///   s = a + tan(phi) (D^2 + a^2) / (D - a tan(phi)),  phi = u d_theta.
/// Where the angle vanishes, sample() and pdf() are uniform.
class EquiangularDistribution {
 public:
  /// @param span  world units, not empty
  EquiangularDistribution(const Ray& ray, Vec3 pivot, Interval span)
      : EquiangularDistribution(foot_of(ray, pivot, span), span) {}

  EquiangularDistribution(PivotFoot foot, Interval span);

  /// @param u  in [0,1)
  DistanceSample sample(float u) const;

  /// Per world unit; 0 outside the span.
  float pdf(float t) const;

 private:
  double pdf_at(double s) const;

  Interval span_;
  PivotFoot foot_;
  double a_, b_;    // ends of the span from the foot
  double d_theta_;  // angle under which the pivot sees the span; 0: uniform
};

}  // namespace brume
