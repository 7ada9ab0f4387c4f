// Trilinear look-up of many points at once: the innermost loop of the march.
#pragma once

#include "renderer/core/transform.h"
#include "renderer/media/brick_grid.h"
#include "renderer/media/shader.h"

namespace brume {

/// out[i] = scale * (trilinear interpolant of the voxels at index_from_scene * (x[i], y[i], z[i])), i in [0, n).
/// Outside grid.support(), and for points that are not finite, the value is 0. Where grid values are >= 0, so is the
/// interpolant.
///
/// Reads x, y, z and writes out up to the next multiple of 16 values. A point's result depends on the point, the grid,
/// the map and the SIMD level only, never on n or its neighbours; between SIMD levels it differs by rounding.
/// Cost: see march_limit.md, "9^3 f32"; 16 points that all fall in empty bricks cost about a third.
/// Any thread; allocates nothing.
void lookup_trilinear(const BrickGrid& grid, const Affine& index_from_scene, const PointBatch& points, float scale,
                      float* out);

/// The same, for a grid far from the origin of index space or of the scene: the offset is taken in double.
void lookup_trilinear(const BrickGrid& grid, const Affined& index_from_scene, const PointBatch& points, float scale,
                      float* out);

}  // namespace brume
