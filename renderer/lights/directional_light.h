#pragma once

#include "renderer/lights/light.h"

namespace brume {

/// Light from infinitely far away, from a round disc of sky of the given angular diameter (0: parallel light):
/// irradiance (W/m^2) on a plane that faces its middle. The disc has the same radiance all over,
///   E = pi L sin^2(radius).
class DirectionalLight final : public Light {
 public:
  /// @param travel  unit direction in which the light travels, from the light to the scene
  /// @param angular_diameter  radians, in [0, pi]
  DirectionalLight(Vec3 travel, Color irradiance, float angular_diameter = 0);
  LightPoint::Kind kind() const override { return LightPoint::Kind::Distant; }
  LightPoint sample_point(Vec2 u) const override;
  std::optional<LightHit> hit(const Ray& ray) const override;
  float solid_angle(Vec3 x) const override;

 private:
  LightPoint point_at(Vec3 direction) const;

  Vec3 travel_;
  Color irradiance_;
  float one_minus_cos_;  // of the disc's radius
};

}  // namespace brume
