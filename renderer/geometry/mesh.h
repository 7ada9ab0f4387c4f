// A mesh that rays can meet, read from a file.
#pragma once

#include <memory>
#include <string>

#include "renderer/core/error.h"
#include "renderer/geometry/triangle_mesh.h"

namespace brume {

class RayScene;

/// Immutable, in its own space; whoever uses it has a transform of its own.
struct Mesh {
  TriangleMesh triangles;                ///< of a closed mesh: facing outward
  std::shared_ptr<const RayScene> rays;  ///< the same triangles, for rays
  std::size_t open_edges = 0;            ///< 0: the mesh is closed and has an inside

  /// Errors: no triangle, an index beyond the vertices, a vertex that is not finite.
  static Result<std::shared_ptr<const Mesh>> make(TriangleMesh triangles);

  /// All triangles of a Wavefront OBJ or a Stanford PLY file; polygons are split. Coordinates are taken as they are.
  /// Errors: no such file, another extension, not what the extension says, and those of make().
  static Result<std::shared_ptr<const Mesh>> read(const std::string& path);
};

}  // namespace brume
