// How fast the innermost loops could be: what benchmarks are held against.
#pragma once

#include "renderer/media/brick_grid.h"

namespace brume {

// Each does the least work that any renderer must do, for one ray, with nothing spared for generality. They were
// measured on one kind of processor (Zen 5) by other means; there a kernel counts as a limit only while it is within a
// fifth of these cycles.

/// Cycles for each sample, segment, or octave and point at a SIMD level ("avx3", "avx2"); 0 where nobody has measured.
struct LimitCycles {
  double lookup = 0, distribute = 0, noise_octave = 0;
};
LimitCycles limit_cycles(const std::string& simd_level);

/// Whether this processor is of the kind that those cycles were measured on; others have other limits.
bool is_processor_of_limit_cycles();

/// Trilinear samples at first + k * step, k in [0, n), in index space, all of them inside the table and not on its
/// upper faces. Writes up to the next multiple of 128 values.
/// @param grid  in Quad layout
void limit_lookup(const BrickGrid& grid, Vec3 first, Vec3 step, int n, float* out);

/// Transmittance and CDF of n equal segments of one medium: a running sum, an exponential and another running sum.
/// @param density  [n].  @param transmittance, cdf  [n], padded by another 16 values
void limit_distribute(const float* density, int n, float sigma_t, float sigma_s, float delta, float* transmittance,
                      float* cdf);

/// Clock of this core now, from a chain of operations that take a cycle each.
double cycles_per_nanosecond();

}  // namespace brume
