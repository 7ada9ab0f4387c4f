#pragma once

#include "renderer/lights/surface_light.h"

namespace brume {

/// A sphere that emits outwards.
class SphereLight final : public SurfaceLight {
 public:
  SphereLight(Vec3 center, float radius, Color radiance)
      : SphereLight(std::make_shared<SphereSurface>(Vec3d(center), double(radius)), radiance) {}

 private:
  SphereLight(const std::shared_ptr<const SphereSurface>& sphere, Color radiance)
      : SurfaceLight(sphere, sphere->sampling(), radiance, false, Hiding::Impossible) {}
};

}  // namespace brume
