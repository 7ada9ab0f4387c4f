#pragma once

#include "renderer/lights/light.h"

namespace brume {

/// Radiates the same radiant intensity (W/sr) in all directions from one point.
class PointLight final : public Light {
 public:
  PointLight(Vec3 position, Color intensity) : position_(position), intensity_(intensity) {}
  LightPoint sample_point(Vec2) const override;
  std::optional<LightPivot> pivot() const override {
    return LightPivot{.position = position_, .intensity = intensity_};
  }

 private:
  Vec3 position_;
  Color intensity_;
};

}  // namespace brume
