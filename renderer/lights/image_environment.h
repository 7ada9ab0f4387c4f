#pragma once

#include "renderer/lights/environment_map.h"
#include "renderer/lights/light.h"

namespace brume {

/// A picture of the surroundings as a light, turned about the z axis.
class ImageEnvironment final : public Light {
 public:
  /// @param scale  radiance of a picture's value of 1, W/(sr m^2).  @param rotation  radians, counter-clockwise seen
  /// from above
  ImageEnvironment(std::shared_ptr<const EnvironmentMap> map, Color scale, float rotation);
  LightPoint::Kind kind() const override { return LightPoint::Kind::Distant; }
  LightPoint sample_point(Vec2 u) const override;
  std::optional<LightHit> hit(const Ray& ray) const override;
  float solid_angle(Vec3 x) const override { return static_cast<void>(x), map_->solid_angle(); }

 private:
  LightHit seen_at(Vec3 direction) const;
  Vec3 to_map(Vec3 d) const { return {cos_ * d.x + sin_ * d.y, cos_ * d.y - sin_ * d.x, d.z}; }
  Vec3 from_map(Vec3 d) const { return {cos_ * d.x - sin_ * d.y, cos_ * d.y + sin_ * d.x, d.z}; }

  std::shared_ptr<const EnvironmentMap> map_;
  Color scale_;
  float cos_, sin_;
};

}  // namespace brume
