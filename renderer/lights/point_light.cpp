#include "renderer/lights/point_light.h"

namespace brume {

LightPoint PointLight::sample_point(Vec2) const { return {LightPoint::Kind::Finite, position_, {}, {}}; }

IncidentLight PointLight::incident(const LightPoint&, Vec3 x) const {
  const Vec3 to_light = position_ - x;
  const float distance = length(to_light);
  if (!(distance > kAtTheLight)) return {{0, 0, 1}, distance, {}};
  return {to_light / distance, distance, intensity_ / (distance * distance)};
}

}  // namespace brume
