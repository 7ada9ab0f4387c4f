#pragma once

#include "renderer/lights/area_light.h"

namespace brume {

/// A parallelogram, emitting along cross(edge_u, edge_v).
class QuadLight final : public AreaLight {
 public:
  QuadLight(Vec3 corner, Vec3 edge_u, Vec3 edge_v, Color radiance, bool two_sided);
  LightPoint sample_point(Vec2 u) const override;

 private:
  std::optional<SurfaceCrossing> meet(const Ray& ray) const override;
  Vec3 plane_normal() const override { return normal_; }

  Vec3 corner_, edge_u_, edge_v_;
  Vec3 normal_;
};

}  // namespace brume
