// The loops over a ray's steps, at SIMD width.
#pragma once

#include "renderer/core/ray.h"
#include "renderer/core/simd.h"

namespace brume {

// Arrays are those of an Arena: 64-byte aligned, and readable and writable up to the next multiple of it.

/// Where a ray is stepped through: n segments from `begin` to `end`, as long as each other but for the last, each
/// looked up at `offset` of its length.
struct StepRow {
  float begin, end, step;  ///< world units
  float offset;            ///< in [0,1)
  int n;
};

/// t[i] = begin + i * step for i in [0, n).  @param t  any alignment; what it holds behind is overwritten
void write_edges(const StepRow& row, float* t);

/// The edges, and the positions of the points where the segments are looked up.
void write_steps(const Ray& ray, const StepRow& row, float* t, float* x, float* y, float* z);

/// out[i] = factor * values[i], or added to what is there; nothing behind `n` is written.  @param out  any alignment
void set_scaled(const float* values, float factor, int n, float* out);
void add_scaled(const float* values, float factor, int n, float* out);

float sum(const float* values, int n);

}  // namespace brume
