// The loops over a ray's steps, at SIMD width.
#pragma once

#include <span>

#include "renderer/core/ray.h"
#include "renderer/core/simd.h"

namespace brume {

// Arrays are those of an Arena: 64-byte aligned, and readable and writable up to the next multiple of it. Arrays of
// edges have one value more than segments and are read and written from the second on: they must be longer by
// kWidestVector values.

// Sums are those of doubles, up to the rounding of the few values that are added in one vector: thousands of thin
// segments add up to the optical depth within float rounding.

/// Where a ray is stepped through: n segments from `begin` on, each looked up at `offset` of its length.
struct StepRow {
  float begin, step;  ///< world units
  float offset;       ///< in [0,1)
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

/// values[i] = exp(-values[i]), for values >= 0.  @param values  any alignment; nothing behind `n` is touched
void exp_minus(float* values, int n);

/// What edges t and extinction sigma_t do to light on its way to t[0].
struct Attenuation {
  float* tau;            ///< [n + 1] sum_{j < i} sigma_t[j] (t[j + 1] - t[j])
  float* transmittance;  ///< [n + 1] exp(-tau[i])
  float* length;         ///< [n] integral of exp(-optical depth from t[0]) over segment i
};
void attenuate(const float* t, const float* sigma_t, int n, const Attenuation& out);

/// The same, with p[i] = sigma_s[i] * length[i] and its running sum.
void attenuate(const float* t, const float* sigma_t, const float* sigma_s, int n, const Attenuation& out, float* p,
               float* cdf);

/// cdf[i] = sum_{j < i} p[j] for i in [0, n]. Never descends, and is exactly flat where p is 0.
/// @param p  >= 0
void running_sum(const float* p, int n, float* cdf);

}  // namespace brume
