// The shapes a scene file can name as the bounds of a volume.
#pragma once

#include "renderer/core/file_cache.h"
#include "renderer/geometry/shape.h"
#include "renderer/params/node.h"

namespace brume {

const Family& shape_family();

/// Errors name the key.
Result<std::shared_ptr<const Shape>> make_shape(const Node& node, FileCache<Mesh>& meshes);

/// The "file" of a node that names a mesh.  Errors name the key.
Result<std::shared_ptr<const Mesh>> load_mesh(const Node& node, FileCache<Mesh>& meshes);

/// The parameter that load_mesh() reads.
Param mesh_file_param();

}  // namespace brume
