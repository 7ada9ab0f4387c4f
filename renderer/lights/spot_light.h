#pragma once

#include "renderer/lights/light.h"

namespace brume {

/// A point light that shines into a cone: its full radiant intensity (W/sr) inside the inner angle, nothing outside the
/// outer one, a smooth step of the cosine between them.
class SpotLight final : public Light {
 public:
  /// @param axis  unit.  @param outer_angle  radians between axis and edge, in (0, pi/2].  @param blend  share of the
  /// cosine's range over which the light falls, in [0, 1]
  SpotLight(Vec3 position, Vec3 axis, float outer_angle, float blend, Color intensity);
  LightPoint sample_point(Vec2) const override;
  Interval lit_part(const LightPoint& point, const Ray& ray) const override;
  std::optional<LightPivot> pivot() const override {
    return LightPivot{.position = position_, .intensity = intensity_};
  }

 private:
  Vec3 position_, axis_;
  float cos_outer_, cos_inner_;
  Color intensity_;
};

}  // namespace brume
