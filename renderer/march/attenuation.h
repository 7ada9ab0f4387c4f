// What a ray's segments do to light, at SIMD width.
#pragma once

#include <cstddef>

#include "renderer/core/arena.h"
#include "renderer/core/simd.h"

namespace brume {

// Arrays are those of an Arena: 64-byte aligned, and readable and writable up to the next multiple of it. Arrays with a
// value for each of n + 1 edges are those of alloc_edges().

/// The second value is aligned, for the loops over segments store at i + 1.
inline float* alloc_edges(int n, Arena& arena) {
  constexpr std::size_t kWide = kWidestVector;
  return arena.alloc_span<float>(static_cast<std::size_t>(n) + 2 * kWide).data() + kWide - 1;
}

/// A ray's segments.
struct Segments {
  const float* t;  ///< [n + 1] edges, world units
  int n;
  float step;  ///< length of all but the last; 0: they differ
};

/// What is proportional to an amount of medium: scale * amount[i] in segment i.
struct Coefficient {
  const float* amount = nullptr;  ///< [n]; several coefficients may share it
  float scale = 1;

  float operator[](std::ptrdiff_t i) const { return scale * amount[i]; }
};

// Sums are those of doubles, up to the rounding of the few values that are added in one vector: thousands of thin
// segments add up to the optical depth within float rounding. A running sum of values that are not negative never
// descends, and stays exactly the same where they are 0.

/// tau[i] = sum_{j < i} sigma_t[j] (t[j + 1] - t[j]) and transmittance[i] = exp(-tau[i]) for i in [0, n].
void attenuate(const Segments& segments, const Coefficient& sigma_t, float* tau, float* transmittance);

/// The same, with cdf[i] = albedo * (1 - transmittance[i]), which keeps its precision where hardly anything is
/// absorbed, or that added to what is there.
void attenuate(const Segments& segments, const Coefficient& sigma_t, float albedo, float* tau, float* transmittance,
               float* cdf);
void attenuate_and_add(const Segments& segments, const Coefficient& sigma_t, float albedo, float* tau,
                       float* transmittance, float* cdf);

/// Of a source, which lies in the medium, what comes through it to t[0]:
///   source[i] * (integral over segment i of exp(-optical depth from t[0])).
/// Every segment's, times a factor, added to what is there; or their sum.
/// @param transmittance  [n + 1], falling by sigma_t
void add_transmitted(const Segments& segments, const Coefficient& sigma_t, const float* transmittance,
                     const Coefficient& source, float factor, float* out);
float sum_transmitted(const Segments& segments, const Coefficient& sigma_t, const float* transmittance,
                      const Coefficient& source);

/// cdf[i] = sum_{j < i} p[j] for i in [0, n].  @param p  [n], >= 0
void running_sum(const float* p, int n, float* cdf);

/// values[i] = exp(-values[i]), for values >= 0.  @param values  any alignment; nothing behind `n` is touched
void exp_minus(float* values, int n);

}  // namespace brume
