// The loops over a ray's steps, at SIMD width.
#pragma once

#include <span>

#include "renderer/core/ray.h"

namespace brume {

// Arrays are those of an Arena: 64-byte aligned, and readable and writable up to the next multiple of 16 values. Sums
// are those of doubles, up to the rounding of the few values that are added in one vector: thousands of thin segments
// add up to the optical depth within float rounding.

/// Positions of n points of a ray, the i-th at t[i] + offset * (t[i + 1] - t[i]).  @param t  [n + 1], any alignment
void write_points(const Ray& ray, const float* t, float offset, int n, float* x, float* y, float* z);

/// A row of points on a ray, the i-th at first + i * step.
struct PointRow {
  float first, step;  ///< world units
  int n;
};

/// Positions of a row's points. The arrays may have any alignment; what they hold behind the row is overwritten.
void write_points(const Ray& ray, const PointRow& row, float* x, float* y, float* z);

/// Any alignment; nothing behind `n` is read.
float sum(const float* values, int n);

/// t[i] = begin + i * step for i in [0, n).  @param t  any alignment; what it holds behind is overwritten
void write_edges(float begin, float step, int n, float* t);

/// out[i] = factor * values[i], or added to what is there; nothing behind `n` is written.  @param out  any alignment
void set_scaled(const float* values, float factor, int n, float* out);
void add_scaled(const float* values, float factor, int n, float* out);

struct Attenuation {
  float* tau;            ///< [n + 1] sum_{j < i} sigma_t[j] (t[j + 1] - t[j])
  float* transmittance;  ///< [n + 1] exp(-tau[i])
  float* length;         ///< [n] integral of exp(-optical depth from t[0]) over segment i
};

/// @param t  [n + 1]; readable, and tau and transmittance writable, up to 16 values behind the last
void attenuate(const float* t, const float* sigma_t, int n, const Attenuation& out);

/// cdf[i] = sum_{j < i} p[j] for i in [0, n]. Never descends, and is exactly flat where p is 0.
/// @param p  >= 0.  @param cdf  writable up to 16 values behind the last
void running_sum(const float* p, int n, float* cdf);

/// The same for p[i] = sum over the channels of weight * sigma_s[i] * length[i], which is written too.
struct ScatteringChannel {
  float weight;
  const float* sigma_s;
  const float* length;
};
void running_sum(std::span<const ScatteringChannel> channels, int n, float* p, float* cdf);

}  // namespace brume
