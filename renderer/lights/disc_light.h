#pragma once

#include "renderer/lights/area_light.h"

namespace brume {

/// A flat disc, emitting along its normal.
class DiscLight final : public AreaLight {
 public:
  /// @param normal  unit
  DiscLight(Vec3 center, Vec3 normal, float radius, Color radiance, bool two_sided)
      : AreaLight(radiance, two_sided, kPi * radius * radius, center),
        center_(center),
        frame_(normal),
        radius_(radius) {}
  LightPoint sample_point(Vec2 u) const override;

 private:
  std::optional<SurfaceCrossing> meet(const Ray& ray) const override;
  Vec3 plane_normal() const override { return frame_.n; }

  Vec3 center_;
  Frame frame_;
  float radius_;
};

}  // namespace brume
