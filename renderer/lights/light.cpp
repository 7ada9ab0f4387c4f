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

}  // namespace brume
