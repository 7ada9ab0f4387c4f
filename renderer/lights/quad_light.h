#pragma once

#include "renderer/lights/light.h"

namespace brume {

/// A parallelogram of constant radiance (W/(sr m^2)), Lambertian, emitting along cross(edge_u, edge_v) or on both
/// sides. Points are drawn uniformly over the area.
class QuadLight final : public Light {
 public:
  QuadLight(Vec3 corner, Vec3 edge_u, Vec3 edge_v, Color radiance, bool two_sided);
  LightPoint sample_point(Vec2 u) const override;
  IncidentLight incident(const LightPoint& point, Vec3 x) const override;
  Interval lit_part(const LightPoint& point, const Ray& ray) const override;
  std::optional<LightHit> hit(const Ray& ray) const override;

 private:
  Vec3 corner_, edge_u_, edge_v_;
  Vec3 normal_;
  float area_;
  Color radiance_;
  bool two_sided_;
};

}  // namespace brume
