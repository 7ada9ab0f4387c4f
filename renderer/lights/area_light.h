// Lights with a surface.
#pragma once

#include "renderer/geometry/surface.h"
#include "renderer/lights/light.h"

namespace brume {

/// A surface of constant radiance (W/(sr m^2)), Lambertian, emitting on the side of its normals or on both. Points are
/// drawn uniformly over the area; kinds differ only in where their points lie.
class AreaLight : public Light {
 public:
  /// The ray above the tangent plane of the point.
  Interval lit_part(const LightPoint& point, const Ray& ray) const final;
  std::optional<LightHit> hit(const Ray& ray) const final;
  float solid_angle(Vec3 x) const override;
  std::optional<LightPivot> pivot() const final;

 protected:
  /// @param middle  of the surface
  AreaLight(Color radiance, bool two_sided, float area, Vec3 middle)
      : radiance_(radiance), two_sided_(two_sided), area_(area), middle_(middle) {}

  /// The nearest place inside ray.span where the ray meets the surface, whichever side it comes from.
  virtual std::optional<SurfaceCrossing> meet(const Ray& ray) const = 0;

  /// Unit normal of the lit side where all of the surface lies in a plane; 0 elsewhere.
  virtual Vec3 plane_normal() const { return {}; }

  LightPoint point_at(Vec3 position, Vec3 normal) const;

  float sampled_area() const { return area_; }
  Vec3 middle() const { return middle_; }

 private:
  Color radiance_;
  bool two_sided_;
  float area_;
  Vec3 middle_;
};

}  // namespace brume
