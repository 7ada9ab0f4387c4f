#include "renderer/lights/area_light.h"

namespace brume {

LightPoint AreaLight::point_at(Vec3 position, Vec3 normal) const {
  return {.position = position,
          .normal = normal,
          .falloff = Falloff::lambertian(two_sided_),
          .sent = radiance_ * area_,
          .pdf = 1 / area_};
}

Interval AreaLight::lit_part(const LightPoint& point, const Ray& ray) const {
  if (two_sided_) return ray.span;
  // Signed height of the ray over the plane: h(t) = h0 + slope t, lit where h > 0.
  const float height = dot(ray.origin - point.position, point.normal), slope = dot(ray.direction, point.normal);
  if (slope == 0) return height > 0 ? ray.span : Interval{};
  const float crossing = -height / slope;
  return intersect(ray.span, slope > 0 ? Interval{crossing, ray.span.end} : Interval{ray.span.begin, crossing});
}

std::optional<LightHit> AreaLight::hit(const Ray& ray) const {
  const auto met = meet(ray);
  if (!met) return std::nullopt;
  const float cosine = -dot(ray.direction, met->normal);
  const float facing = two_sided_ ? std::abs(cosine) : cosine;
  if (!(facing > 0)) return std::nullopt;
  return LightHit{met->t, radiance_, met->t * met->t / (facing * area_), point_at(ray.at(met->t), met->normal)};
}

std::optional<LightPivot> AreaLight::pivot() const {
  return LightPivot{.position = middle_,
                    .radius = 0.25f * std::sqrt(area_),
                    .normal = plane_normal(),
                    .two_sided = two_sided_,
                    .intensity = radiance_ * area_};
}

float AreaLight::solid_angle(Vec3 x) const {
  const float half_space = 2 * kPi, d2 = length_squared(middle_ - x);
  return half_space * d2 > area_ ? area_ / d2 : half_space;
}

}  // namespace brume
