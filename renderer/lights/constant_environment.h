#pragma once

#include "renderer/lights/light.h"

namespace brume {

/// The same radiance (W/(sr m^2)) from every direction. A scattering point draws the direction from its phase
/// function, whose pdf then cancels: nothing is left to vary but the transmittance.
class ConstantEnvironment final : public Light {
 public:
  explicit ConstantEnvironment(Color radiance) : radiance_(radiance) {}
  LightPoint::Kind kind() const override { return LightPoint::Kind::Environment; }
  LightPoint sample_point(Vec2) const override;
  Color environment_radiance() const override { return radiance_; }
  std::optional<LightHit> hit(const Ray& ray) const override;

 private:
  Color radiance_;
};

}  // namespace brume
