// Things that stop rays.
#pragma once

#include <memory>
#include <optional>

#include "renderer/core/ray.h"
#include "renderer/core/transform.h"
#include "renderer/geometry/mesh.h"

namespace brume {

struct SurfaceCrossing {
  float t;      ///< world units
  Vec3 normal;  ///< unit, of the front: outward on a closed surface
};

/// Points drawn uniformly over a surface.
class SurfaceSampling {
 public:
  virtual ~SurfaceSampling() = default;
  struct Point {
    Vec3 position, normal;
  };
  /// @param u  in [0,1)^2
  virtual Point sample(Vec2 u) const = 0;
  virtual double area() const = 0;
};

/// Immutable; any thread.
class Surface {
 public:
  virtual ~Surface() = default;

  /// The nearest crossing inside ray.span.
  virtual std::optional<SurfaceCrossing> intersect(const Ray& ray) const = 0;
  virtual bool occluded(const Ray& ray) const { return intersect(ray).has_value(); }
  virtual Bounds3 bounds() const = 0;
  virtual bool endless() const { return false; }

  /// Null for an endless surface and for one without area. Made when asked for: only surfaces that shine need it.
  virtual std::unique_ptr<const SurfaceSampling> sampling() const = 0;
};

class SphereSurface final : public Surface {
 public:
  SphereSurface(Vec3d center, double radius) : center_(center), radius_(radius) {}
  std::optional<SurfaceCrossing> intersect(const Ray& ray) const override;
  Bounds3 bounds() const override { return {center_ - Vec3d(radius_), center_ + Vec3d(radius_)}; }
  std::unique_ptr<const SurfaceSampling> sampling() const override;

 private:
  Vec3d center_;
  double radius_;
};

/// Without end.
class PlaneSurface final : public Surface {
 public:
  /// @param normal  unit
  PlaneSurface(Vec3d point, Vec3d normal) : point_(point), normal_(normal) {}
  std::optional<SurfaceCrossing> intersect(const Ray& ray) const override;
  Bounds3 bounds() const override;
  bool endless() const override { return true; }
  std::unique_ptr<const SurfaceSampling> sampling() const override { return nullptr; }

 private:
  Vec3d point_, normal_;
};

class MeshSurface final : public Surface {
 public:
  /// @param scene_from_mesh  invertible
  MeshSurface(std::shared_ptr<const Mesh> mesh, const Affined& scene_from_mesh);
  std::optional<SurfaceCrossing> intersect(const Ray& ray) const override;
  bool occluded(const Ray& ray) const override;
  Bounds3 bounds() const override { return bounds_; }
  std::unique_ptr<const SurfaceSampling> sampling() const override;

 private:
  Ray in_mesh(const Ray& ray) const;

  std::shared_ptr<const Mesh> mesh_;
  Affined scene_from_mesh_;
  Affine mesh_from_scene_;
  Bounds3 bounds_;
};

}  // namespace brume
