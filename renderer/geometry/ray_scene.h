// Triangles that rays hit; Embree behind our own types.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "renderer/core/error.h"
#include "renderer/core/ray.h"

namespace brume {

struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices of vertices
};

struct TriangleHit {
  float t;             ///< world units
  Vec3 normal;         ///< unit, of the face: cross(v1 - v0, v2 - v0)
  std::uint32_t mesh;  ///< in the order given to make()
  std::uint32_t triangle;
};

/// An immutable set of meshes with its acceleration structure. Any thread may ask. A scene without surfaces makes none,
/// and then Embree is never started.
class TriangleScene {
 public:
  /// Errors: an index beyond the vertices, a vertex that is not finite, Embree out of memory.
  static Result<std::shared_ptr<const TriangleScene>> make(const std::vector<TriangleMesh>& meshes);
  ~TriangleScene();
  TriangleScene(const TriangleScene&) = delete;
  TriangleScene& operator=(const TriangleScene&) = delete;

  /// The nearest hit inside ray.span.
  std::optional<TriangleHit> intersect(const Ray& ray) const;
  /// Whether anything is hit inside ray.span.
  bool occluded(const Ray& ray) const;

 private:
  struct State;
  explicit TriangleScene(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace brume
