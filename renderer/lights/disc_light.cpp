#include "renderer/lights/disc_light.h"

#include "renderer/sampling/warps.h"

namespace brume {

LightPoint DiscLight::sample_point(Vec2 u) const {
  const Vec2 p = uniform_disc(u);
  return point_at(center_ + frame_.s * (p.x * radius_) + frame_.t * (p.y * radius_), frame_.n);
}

std::optional<SurfaceCrossing> DiscLight::meet(const Ray& ray) const {
  const float slope = dot(ray.direction, frame_.n);
  if (slope == 0) return std::nullopt;
  const float t = dot(center_ - ray.origin, frame_.n) / slope;
  if (!(t > ray.span.begin && t < ray.span.end)) return std::nullopt;
  if (length_squared(ray.at(t) - center_) > radius_ * radius_) return std::nullopt;
  return SurfaceCrossing{t, frame_.n};
}

}  // namespace brume
