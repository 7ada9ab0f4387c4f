#include "renderer/lights/light.h"

namespace brume {

Interval Light::lit_part(const LightPoint&, const Ray& ray) const { return ray.span; }

std::optional<LightHit> Light::hit(const Ray&) const { return std::nullopt; }

float Light::solid_angle(Vec3) const { return 0; }

}  // namespace brume
