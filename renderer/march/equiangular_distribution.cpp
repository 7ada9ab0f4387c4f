#include "renderer/march/equiangular_distribution.h"

namespace brume {

PivotFoot foot_of(const Ray& ray, Vec3 pivot, Interval span) {
  const Vec3d to_pivot = Vec3d(pivot) - Vec3d(ray.origin), direction(ray.direction);
  const double foot = dot(to_pivot, direction);
  const double reach = std::max(std::abs(span.begin - foot), std::abs(span.end - foot));
  return {foot, std::max(length(to_pivot - direction * foot), kLeastPivotDistance * reach)};
}

// In double: with the pivot 1e-6 of the span from the ray, float angles would leave a handful of distinct distances.
EquiangularDistribution::EquiangularDistribution(PivotFoot foot, Interval span)
    : span_(span), foot_(foot), a_(span.begin - foot.t), b_(span.end - foot.t) {
  d_theta_ = std::atan2(foot_.distance * (b_ - a_), foot_.distance * foot_.distance + a_ * b_);
  if (!(d_theta_ > 1e-30) || !std::isfinite(d_theta_)) d_theta_ = 0;
}

double EquiangularDistribution::pdf_at(double s) const {
  if (d_theta_ == 0) return 1.0 / (b_ - a_);
  return foot_.distance / (d_theta_ * (foot_.distance * foot_.distance + s * s));
}

DistanceSample EquiangularDistribution::sample(float u) const {
  double s;
  if (d_theta_ == 0) {
    s = a_ + u * (b_ - a_);
  } else if (a_ * b_ <= 0) {
    // The foot is inside: measured from it, distances next to the light keep their relative precision.
    s = foot_.distance * std::tan(std::atan2(a_, foot_.distance) + u * d_theta_);
  } else {
    // Measured from the end of the span that is nearer to the foot.
    const double near = a_ > 0 ? a_ : -b_, tangent = std::tan(u * d_theta_);
    const double away =
        near + tangent * (foot_.distance * foot_.distance + near * near) / (foot_.distance - near * tangent);
    s = a_ > 0 ? away : -away;
  }
  s = std::clamp(s, a_, b_);
  const float t = std::clamp(static_cast<float>(foot_.t + s), span_.begin, span_.end);
  return {t, static_cast<float>(pdf_at(s))};
}

float EquiangularDistribution::pdf(float t) const {
  if (t < span_.begin || t > span_.end) return 0;
  return static_cast<float>(pdf_at(t - foot_.t));
}

}  // namespace brume
