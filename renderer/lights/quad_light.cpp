#include "renderer/lights/quad_light.h"

namespace brume {

QuadLight::QuadLight(Vec3 corner, Vec3 edge_u, Vec3 edge_v, Color radiance, bool two_sided)
    : AreaLight(radiance, two_sided, length(cross(edge_u, edge_v)), corner + (edge_u + edge_v) * 0.5f),
      corner_(corner),
      edge_u_(edge_u),
      edge_v_(edge_v),
      normal_(cross(edge_u, edge_v) / sampled_area()) {}

LightPoint QuadLight::sample_point(Vec2 u) const { return point_at(corner_ + edge_u_ * u.x + edge_v_ * u.y, normal_); }

std::optional<SurfaceCrossing> QuadLight::meet(const Ray& ray) const {
  const float slope = dot(ray.direction, normal_);
  if (slope == 0) return std::nullopt;
  const float t = dot(corner_ - ray.origin, normal_) / slope;
  if (!(t > ray.span.begin && t < ray.span.end)) return std::nullopt;
  // Barycentric coordinates from the areas spanned with the edges.
  const Vec3 p = ray.at(t) - corner_;
  const float u = dot(cross(p, edge_v_), normal_) / sampled_area(),
              v = dot(cross(edge_u_, p), normal_) / sampled_area();
  if (u < 0 || u > 1 || v < 0 || v > 1) return std::nullopt;
  return SurfaceCrossing{t, normal_};
}

}  // namespace brume
