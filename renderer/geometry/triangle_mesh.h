// Triangles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "renderer/core/bounds.h"

namespace brume {

struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices of vertices; the side of cross(v1 - v0, v2 - v0)
                                                        ///< is the front
  std::array<Vec3, 3> corners(std::size_t triangle) const {
    const auto& t = triangles[triangle];
    return {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
  }
  Bounds3 bounds() const;
};

/// Edges that do not close: those along which as many triangles do not run one way as the other. Vertices at the same
/// place are one. 0 for a closed mesh whose triangles agree on which side is out; only then "inside" has a meaning.
std::size_t open_edges(const TriangleMesh& mesh);

/// Volume inside a closed mesh; negative when the triangles face inwards.
double signed_volume(const TriangleMesh& mesh);

}  // namespace brume
