// Closed shapes that bound a medium.
#pragma once

#include <memory>
#include <span>

#include "renderer/core/arena.h"
#include "renderer/core/bounds.h"
#include "renderer/core/ray.h"
#include "renderer/geometry/mesh.h"

namespace brume {

/// Immutable; any thread.
class Shape {
 public:
  virtual ~Shape() = default;

  /// The parts of the ray inside the shape and inside ray.span, in order of t, none empty. The ray's direction need
  /// not be unit: t keeps its meaning when a ray is carried into the shape's own space.
  virtual std::span<const Interval> intervals(const Ray& ray, Arena& arena) const = 0;

  virtual Bounds3 bounds() const = 0;

  /// The shape itself where it is an axis-aligned box, which many rays can be clipped to at once; null elsewhere.
  virtual const Bounds3* box() const { return nullptr; }
};

class BoxShape final : public Shape {
 public:
  BoxShape(Vec3d low, Vec3d high) : box_{low, high} {}
  std::span<const Interval> intervals(const Ray& ray, Arena& arena) const override;
  Bounds3 bounds() const override { return box_; }
  const Bounds3* box() const override { return &box_; }

 private:
  Bounds3 box_;
};

class SphereShape final : public Shape {
 public:
  SphereShape(Vec3d center, double radius) : center_(center), radius_(radius) {}
  std::span<const Interval> intervals(const Ray& ray, Arena& arena) const override;
  Bounds3 bounds() const override { return {center_ - Vec3d(radius_), center_ + Vec3d(radius_)}; }

 private:
  Vec3d center_;
  double radius_;
};

/// The inside of a closed mesh: where the surface winds round a point more often outward than inward.
class MeshShape final : public Shape {
 public:
  /// @param mesh  without open edges
  explicit MeshShape(std::shared_ptr<const Mesh> mesh) : mesh_(std::move(mesh)), bounds_(mesh_->triangles.bounds()) {}
  std::span<const Interval> intervals(const Ray& ray, Arena& arena) const override;
  Bounds3 bounds() const override { return bounds_; }

 private:
  std::shared_ptr<const Mesh> mesh_;
  Bounds3 bounds_;
};

}  // namespace brume
