#include "renderer/lights/constant_environment.h"

namespace brume {

LightPoint ConstantEnvironment::sample_point(Vec2) const { return {.kind = LightPoint::Kind::Environment}; }

std::optional<LightHit> ConstantEnvironment::hit(const Ray& ray) const {
  if (ray.span.end != std::numeric_limits<float>::infinity()) return std::nullopt;
  return LightHit{ray.span.end, radiance_};
}

}  // namespace brume
