#include "renderer/lights/sphere_light.h"

#include "renderer/sampling/warps.h"

namespace brume {

LightPoint SphereLight::sample_point(Vec2 u) const {
  const Vec3 n = uniform_sphere(u);
  return {LightPoint::Kind::Finite, center_ + n * radius_, {}, n};
}

float SphereLight::solid_angle(Vec3 x) const {
  const float sin2 = radius_ * radius_ / length_squared(center_ - x);
  return sin2 < 1 ? 2 * kPi * sin2 / (1 + std::sqrt(1 - sin2)) : 2 * kPi;
}

std::optional<AreaLight::Meeting> SphereLight::meet(const Ray& ray) const {
  // Relative to the point of the ray nearest to the centre, in double: a small sphere far away keeps its roundness.
  const Vec3d to_center = Vec3d(center_) - Vec3d(ray.origin), d(ray.direction);
  const double middle = dot(to_center, d), r = static_cast<double>(radius_);
  const double rest = r * r - length_squared(to_center - d * middle);
  if (!(rest > 0)) return std::nullopt;
  const double t = middle - std::sqrt(rest);
  if (!(t > static_cast<double>(ray.span.begin) && t < static_cast<double>(ray.span.end))) return std::nullopt;
  return Meeting{static_cast<float>(t), Vec3((d * t - to_center) / r)};
}

}  // namespace brume
