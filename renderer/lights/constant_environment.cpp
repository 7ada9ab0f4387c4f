#include "renderer/lights/constant_environment.h"

namespace brume {

LightPoint ConstantEnvironment::sample_point(Vec2) const { return {LightPoint::Kind::Environment, {}, {}, {}}; }

IncidentLight ConstantEnvironment::incident(const LightPoint& point, Vec3) const {
  return {point.direction, std::numeric_limits<float>::infinity(), {}, 0};
}

std::optional<LightHit> ConstantEnvironment::hit(const Ray& ray) const {
  if (ray.span.end != std::numeric_limits<float>::infinity()) return std::nullopt;
  return LightHit{ray.span.end, radiance_};
}

}  // namespace brume
