#include "renderer/lights/light.h"

#include "renderer/geometry/surface.h"

namespace brume {

IncidentLight Light::incident(const LightPoint& point, Vec3 x) const {
  IncidentLight in = brume::incident(point, x);
  if (const Surface* own = own_shadow(); own && !is_black(in.irradiance))
    if (own->occluded({x, in.wi, {0, in.distance * kJustBefore}})) in.irradiance = {};
  return in;
}

Interval Light::lit_part(const LightPoint&, const Ray& ray) const { return ray.span; }

std::optional<LightHit> Light::hit(const Ray&) const { return std::nullopt; }

float Light::solid_angle(Vec3) const { return 0; }

float Light::largest_solid_angle(const Ray& ray) const {
  const auto seen = pivot();
  if (!seen) return solid_angle(ray.origin);
  const float foot = dot(seen->position - ray.origin, ray.direction);
  return solid_angle(ray.at(std::clamp(foot, ray.span.begin, ray.span.end)));
}

float Light::largest_solid_angle(const Bounds3& box) const {
  const auto seen = pivot();
  return solid_angle(seen ? Vec3(min(max(Vec3d(seen->position), box.low), box.high)) : Vec3());
}

}  // namespace brume
