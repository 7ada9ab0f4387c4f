#include "renderer/lights/spot_light.h"

namespace brume {

SpotLight::SpotLight(Vec3 position, Vec3 axis, float outer_angle, float blend, Color intensity)
    : position_(position),
      axis_(axis),
      cos_outer_(std::max(0.0f, std::cos(outer_angle))),
      cos_inner_(cos_outer_ + blend * (1 - cos_outer_)),
      intensity_(intensity) {}

LightPoint SpotLight::sample_point(Vec2) const {
  return {.position = position_, .normal = axis_, .falloff = Falloff::cone(cos_outer_, cos_inner_), .sent = intensity_};
}

Interval SpotLight::lit_part(const LightPoint&, const Ray& ray) const {
  // Inside the cone: with v = x - position, dot(v, axis) >= |v| cos(outer). Squared, this is A t^2 + 2 B t + C >= 0
  // and also holds in the mirrored cone, which dot(v, axis) >= 0 takes away. The cone is convex: one interval.
  const Vec3d v = Vec3d(ray.origin) - Vec3d(position_), d(ray.direction), axis(axis_);
  // A float direction has not exactly unit length, and seen from far away that would matter.
  const double k = static_cast<double>(cos_outer_) * static_cast<double>(cos_outer_) * length_squared(axis);
  const double va = dot(v, axis), da = dot(d, axis);
  const double a = da * da - k * length_squared(d), b = va * da - k * dot(v, d), c = va * va - k * length_squared(v);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double begin = -kInfinity, end = kInfinity;
  const double discriminant = b * b - a * c;
  if (a == 0) {
    if (b == 0) {
      if (c < 0) return {};
    } else {
      (b > 0 ? begin : end) = -c / (2 * b);
    }
  } else if (discriminant > 0) {
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));  // neither root cancels
    const double r1 = q / a, r2 = q != 0 ? c / q : 0;
    const double first = std::min(r1, r2), second = std::max(r1, r2);
    if (a < 0) {
      begin = first, end = second;
    } else if (da > 0) {
      begin = second;  // it enters the cone and stays inside
    } else {
      end = first;
    }
  } else if (a < 0) {
    return {};
  }
  // Before or behind the plane through the tip.
  if (da > 0) begin = std::max(begin, -va / da);
  if (da < 0) end = std::min(end, -va / da);
  if (da == 0 && va < 0) return {};
  if (!(begin < end)) return {};
  return intersect(ray.span, {static_cast<float>(begin), static_cast<float>(end)});
}

}  // namespace brume
