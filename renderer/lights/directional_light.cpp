#include "renderer/lights/directional_light.h"

#include "renderer/sampling/warps.h"

namespace brume {

namespace {
constexpr float kInfinity = std::numeric_limits<float>::infinity();
}

DirectionalLight::DirectionalLight(Vec3 travel, Color irradiance, float angular_diameter)
    : travel_(travel), irradiance_(irradiance) {
  const float s = std::sin(angular_diameter / 4);
  one_minus_cos_ = 2 * s * s;
}

LightPoint DirectionalLight::point_at(Vec3 direction) const {
  LightPoint point{.kind = LightPoint::Kind::Distant, .direction = direction, .sent = irradiance_};
  if (one_minus_cos_ == 0) return point;
  // L / pdf = E / (pi sin^2) * 2 pi (1 - cos) = 2 E / (1 + cos).
  point.sent *= 2 / (2 - one_minus_cos_);
  point.pdf = 1 / (2 * kPi * one_minus_cos_);
  return point;
}

LightPoint DirectionalLight::sample_point(Vec2 u) const {
  return point_at(one_minus_cos_ > 0 ? uniform_cone(-travel_, one_minus_cos_, u) : -travel_);
}

std::optional<LightHit> DirectionalLight::hit(const Ray& ray) const {
  if (one_minus_cos_ == 0 || ray.span.end != kInfinity) return std::nullopt;
  // 1 - cos of the angle to the middle, from the distance between the unit vectors: small discs keep their shape.
  if (0.5f * length_squared(ray.direction + travel_) > one_minus_cos_) return std::nullopt;
  const Color radiance = irradiance_ / (kPi * one_minus_cos_ * (2 - one_minus_cos_));
  const LightPoint point = point_at(ray.direction);
  return LightHit{kInfinity, radiance, point.pdf, point};
}

float DirectionalLight::solid_angle(Vec3) const { return 2 * kPi * one_minus_cos_; }

}  // namespace brume
