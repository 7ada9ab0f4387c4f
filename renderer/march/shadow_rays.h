// Rays towards lights, and the loops over many of them at SIMD width.
#pragma once

#include <span>
#include <utility>

#include "renderer/core/arena.h"
#include "renderer/core/ray.h"
#include "renderer/core/simd.h"
#include "renderer/core/transform.h"

namespace brume {

/// Structure of arrays, in an arena.
struct ShadowRays {
  float* origin[3];
  float* direction[3];
  float* begin;  ///< of the span, world units
  float* end;
  float* offset;  ///< in [0,1), as MarchSettings::offset
  int n = 0;

  ShadowRays(int capacity, Arena& arena) {
    const std::size_t stride = whole_vectors(capacity);
    float* array = arena.alloc_span<float>(9 * stride).data();
    for (float** const a :
         {&origin[0], &origin[1], &origin[2], &direction[0], &direction[1], &direction[2], &begin, &end, &offset})
      *a = std::exchange(array, array + stride);
  }

  void add(const Ray& ray, float its_offset) {
    for (int axis = 0; axis < 3; ++axis) origin[axis][n] = ray.origin[axis], direction[axis][n] = ray.direction[axis];
    begin[n] = ray.span.begin, end[n] = ray.span.end, offset[n] = its_offset;
    ++n;
  }

  Ray operator[](int i) const {
    return {{origin[0][i], origin[1][i], origin[2][i]},
            {direction[0][i], direction[1][i], direction[2][i]},
            {begin[i], end[i]}};
  }
};

/// The part of every ray that is inside an axis-aligned box of another space; empty where from[i] >= to[i].
/// @param from, to  [n], padded to whole vectors
void clip_to_box(const ShadowRays& rays, const Affine& box_from_scene, Vec3 low, Vec3 high, float* from, float* to);

/// Points on one of the rays, of equal steps but for the last, which may be shorter.
struct ShadowRow {
  int ray;
  int first, n;     ///< of its points in the arrays
  float begin;      ///< t of the first point
  float step;       ///< from each to the next
  float last;       ///< t of the last point
  float last_step;  ///< length of its segment
};

/// @param x, y, z  as long as all rows together, and a whole vector more
void write_points(const ShadowRays& rays, std::span<const ShadowRow> rows, float* x, float* y, float* z);

/// amounts[ray] += sum of density times the segments' lengths, for each row.
void add_amounts(std::span<const ShadowRow> rows, const float* density, double* amounts);

}  // namespace brume
