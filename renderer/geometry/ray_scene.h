// What rays meet first; Embree behind our own types.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "renderer/core/arena.h"
#include "renderer/core/error.h"
#include "renderer/core/ray.h"

namespace brume {

class Surface;
struct TriangleMesh;

struct RayHit {
  float t;              ///< in lengths of the ray's direction
  Vec3 normal;          ///< unit, of the front; of a triangle: cross(v1 - v0, v2 - v0)
  std::uint32_t index;  ///< of the triangle or the surface
};

/// A ray going in or out of a closed mesh.
struct MeshCrossing {
  float t;
  bool entering;
};

/// An immutable set of triangles or of surfaces, with its acceleration structure. Any thread may ask. Rays' directions
/// need not be unit.
class RayScene {
 public:
  /// @param mesh  with indices and vertices that have been checked.  Errors: Embree out of memory.
  static Result<std::shared_ptr<const RayScene>> of(const TriangleMesh& mesh);
  static Result<std::shared_ptr<const RayScene>> of(std::vector<std::shared_ptr<const Surface>> surfaces);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  /// The nearest hit inside ray.span.
  std::optional<RayHit> intersect(const Ray& ray) const;
  /// Whether anything is hit inside ray.span.
  bool occluded(const Ray& ray) const;

  /// All triangles that the ray goes through inside ray.span, in order of t; the shared edge of two triangles counts
  /// once. Lives in the arena.
  std::span<const MeshCrossing> crossings(const Ray& ray, Arena& arena) const;

 private:
  struct State;
  explicit RayScene(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace brume
