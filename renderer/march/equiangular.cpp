#include "renderer/march/equiangular.h"

namespace brume {

EquiangularSampling::Foot EquiangularSampling::foot_of(const Ray& ray, Vec3 pivot, Interval span) {
  const Vec3d to_pivot = Vec3d(pivot) - Vec3d(ray.origin), direction(ray.direction);
  const double foot = dot(to_pivot, direction);
  const double reach = std::max(std::abs(span.begin - foot), std::abs(span.end - foot));
  return {foot, std::max(length(to_pivot - direction * foot), 1e-7 * reach)};
}

EquiangularSampling::EquiangularSampling(const Ray& ray, Vec3 pivot, Interval span)
    : EquiangularSampling(foot_of(ray, pivot, span), span) {}

// In double: with the pivot 1e-6 of the span from the ray, float angles would leave a handful of distinct distances.
EquiangularSampling::EquiangularSampling(Foot foot, Interval span)
    : span_(span), foot_(foot.t), distance_(foot.distance), a_(span.begin - foot.t), b_(span.end - foot.t) {
  d_theta_ = std::atan2(distance_ * (b_ - a_), distance_ * distance_ + a_ * b_);
  if (!(d_theta_ > 1e-30) || !std::isfinite(d_theta_)) d_theta_ = 0;
}

double EquiangularSampling::pdf_at(double s) const {
  if (d_theta_ == 0) return 1.0 / (b_ - a_);
  return distance_ / (d_theta_ * (distance_ * distance_ + s * s));
}

DistanceSample EquiangularSampling::sample(float u) const {
  double s;
  if (d_theta_ == 0) {
    s = a_ + u * (b_ - a_);
  } else if (a_ * b_ <= 0) {
    // The foot is inside: measured from it, distances next to the light keep their relative precision.
    s = distance_ * std::tan(std::atan2(a_, distance_) + u * d_theta_);
  } else {
    // Measured from the end of the span that is nearer to the foot.
    const double near = a_ > 0 ? a_ : -b_, tangent = std::tan(u * d_theta_);
    const double away = near + tangent * (distance_ * distance_ + near * near) / (distance_ - near * tangent);
    s = a_ > 0 ? away : -away;
  }
  s = std::clamp(s, a_, b_);
  const float t = std::clamp(static_cast<float>(foot_ + s), span_.begin, span_.end);
  return {t, static_cast<float>(pdf_at(s))};
}

float EquiangularSampling::pdf(float t) const {
  if (t < span_.begin || t > span_.end) return 0;
  return static_cast<float>(pdf_at(t - foot_));
}

}  // namespace brume
