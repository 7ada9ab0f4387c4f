// Stanford PLY: the polygon file format (Turk 1994).
#pragma once

#include "renderer/core/error.h"
#include "renderer/geometry/triangle_mesh.h"

namespace brume {

/// The vertices and faces of a PLY file in ASCII or either binary order; faces of more than three corners are split into
/// a fan. Everything else in the file is skipped. Our own reader, since no packaged one survives damaged files.
/// Errors name the file: not a PLY file, no vertices or faces, cut short, damaged.
Result<TriangleMesh> read_ply(const std::string& path);

}  // namespace brume
