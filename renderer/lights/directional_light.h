#pragma once

#include "renderer/lights/light.h"

namespace brume {

/// Parallel light: irradiance (W/m^2) on a plane that faces it.
class DirectionalLight final : public Light {
 public:
  /// @param travel  unit direction in which the light travels, from the light to the scene
  DirectionalLight(Vec3 travel, Color irradiance) : travel_(travel), irradiance_(irradiance) {}
  LightPoint sample_point(Vec2) const override;
  IncidentLight incident(const LightPoint& point, Vec3 x) const override;

 private:
  Vec3 travel_;
  Color irradiance_;
};

}  // namespace brume
