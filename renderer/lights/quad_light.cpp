#include "renderer/lights/quad_light.h"

namespace brume {

QuadLight::QuadLight(Vec3 corner, Vec3 edge_u, Vec3 edge_v, Color radiance, bool two_sided)
    : corner_(corner), edge_u_(edge_u), edge_v_(edge_v), radiance_(radiance), two_sided_(two_sided) {
  const Vec3 n = cross(edge_u, edge_v);
  area_ = length(n);
  normal_ = n / area_;
}

LightPoint QuadLight::sample_point(Vec2 u) const {
  return {LightPoint::Kind::Finite, corner_ + edge_u_ * u.x + edge_v_ * u.y, {}};
}

IncidentLight QuadLight::incident(const LightPoint& point, Vec3 x) const {
  const Vec3 to_light = point.position - x;
  const float distance = length(to_light);
  const Vec3 wi = to_light / distance;
  const float cosine = -dot(wi, normal_);
  const float facing = two_sided_ ? std::abs(cosine) : std::max(0.0f, cosine);
  return {wi, distance, radiance_ * (facing * area_ / (distance * distance))};
}

Interval QuadLight::lit_part(const LightPoint&, const Ray& ray) const {
  if (two_sided_) return ray.span;
  // Signed height of the ray over the quad's plane: h(t) = h0 + slope t, lit where h > 0.
  const float height = dot(ray.origin - corner_, normal_), slope = dot(ray.direction, normal_);
  if (slope == 0) return height > 0 ? ray.span : Interval{};
  const float crossing = -height / slope;
  return intersect(ray.span, slope > 0 ? Interval{crossing, ray.span.end} : Interval{ray.span.begin, crossing});
}

std::optional<LightHit> QuadLight::hit(const Ray& ray) const {
  const float slope = dot(ray.direction, normal_);
  if (slope == 0 || (slope > 0 && !two_sided_)) return std::nullopt;
  const float t = dot(corner_ - ray.origin, normal_) / slope;
  if (!(t > ray.span.begin && t < ray.span.end)) return std::nullopt;
  // Barycentric coordinates from the areas spanned with the edges.
  const Vec3 p = ray.at(t) - corner_;
  const float u = dot(cross(p, edge_v_), normal_) / area_, v = dot(cross(edge_u_, p), normal_) / area_;
  if (u < 0 || u > 1 || v < 0 || v > 1) return std::nullopt;
  return LightHit{t, radiance_};
}

}  // namespace brume
