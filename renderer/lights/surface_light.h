#pragma once

#include "renderer/geometry/surface.h"
#include "renderer/lights/area_light.h"

namespace brume {

/// A surface with an end that glows: the front of a mesh, of a sphere, or both of its sides.
class SurfaceLight : public AreaLight {
 public:
  /// Who keeps the light of one part of the surface from shining through another part.
  enum class Hiding {
    ByLight,     ///< the light: it stops no other light
    ByScene,     ///< the scene, of which the surface is a part and stops every light
    Impossible,  ///< a convex surface that glows outwards
  };
  /// @param sampling  of the surface
  SurfaceLight(std::shared_ptr<const Surface> surface, std::unique_ptr<const SurfaceSampling> sampling, Color radiance,
               bool two_sided, Hiding hiding)
      : AreaLight(radiance, two_sided, static_cast<float>(sampling->area()), Vec3(surface->bounds().center())),
        surface_(std::move(surface)),
        sampling_(std::move(sampling)),
        hiding_(hiding) {}

  LightPoint sample_point(Vec2 u) const override;
  const Surface* own_shadow() const override { return hiding_ == Hiding::ByLight ? surface_.get() : nullptr; }
  float solid_angle(Vec3 x) const override;

 private:
  std::optional<SurfaceCrossing> meet(const Ray& ray) const override { return surface_->intersect(ray); }

  std::shared_ptr<const Surface> surface_;
  std::unique_ptr<const SurfaceSampling> sampling_;
  Hiding hiding_;
};

}  // namespace brume
