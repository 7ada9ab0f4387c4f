#pragma once

#include "renderer/lights/area_light.h"

namespace brume {

/// A sphere that emits outwards.
class SphereLight final : public AreaLight {
 public:
  SphereLight(Vec3 center, float radius, Color radiance)
      : AreaLight(radiance, false, 4 * kPi * radius * radius, center), center_(center), radius_(radius) {}
  LightPoint sample_point(Vec2 u) const override;
  float solid_angle(Vec3 x) const override;

 private:
  std::optional<Meeting> meet(const Ray& ray) const override;

  Vec3 center_;
  float radius_;
};

}  // namespace brume
