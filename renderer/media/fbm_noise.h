// Fractal gradient noise, evaluated for many points at once.
#pragma once

#include <array>
#include <cstdint>

#include "renderer/core/transform.h"
#include "renderer/media/shader.h"

namespace brume {

/// What the noise looks like. Values outside the ranges are moved to the nearest end.
struct FbmSettings {
  float frequency = 1;     ///< lattice cells of the first octave per unit of noise space; >= 0
  int octaves = 6;         ///< 1 to kMaxFbmOctaves
  float lacunarity = 2;    ///< ratio of the frequencies of neighbouring octaves; >= 1
  float gain = 0.5f;       ///< ratio of their amplitudes; >= 0
  std::uint32_t seed = 0;  ///< which of 2^32 unrelated noises
  float billow = 0;        ///< 0 to 1: from smooth noise to |noise| in every octave, which has round lumps and creases
};

constexpr int kMaxFbmOctaves = 16;

/// A sum of octaves of gradient noise, ready to be evaluated:
///
///   fbm(x) = sum_o w_o s(n_o(f_o R_o x + c_o)),   f_o = frequency lacunarity^o,   w_o = gain^o / sqrt(sum_k gain^2k)
///
/// n_o is gradient noise: every corner of the unit lattice has a random linear function that vanishes there, and inside
/// a cell its eight are blended by 6t^5 - 15t^4 + 10t^3 (Perlin 2002, "Improving Noise"). The rotation R_o and the
/// offset c_o differ between octaves, so that neither the zeros nor the axes of the lattices coincide. s is the
/// identity for billow = 0 and becomes |n| less its mean (Perlin 1985, "An Image Synthesizer", section "Turbulence")
/// for billow = 1.
///
/// The mean is about 0. Dividing by the root of the sum of squares keeps the standard deviation at 0.3 for any octaves,
/// gain and billow. For billow = 0 99.9 % of all values lie in [-1,1], otherwise more than 98.5 %; bound() holds
/// always. Continuous up to the second derivatives for billow = 0, but for the creases otherwise.
///
/// A plain value, immutable; any thread. Making one costs about 0.1 us per octave: keep it.
class FbmNoise {
 public:
  /// @param to_noise  from the space of the points to noise space; any affine map
  FbmNoise(const Affine& to_noise, const FbmSettings& settings);

  /// Writes out[0..n); may write up to the next multiple of 16 values. A value depends on its point and the SIMD level
  /// only: the same bits however the points are split into batches; two levels differ by rounding.
  /// Finite for coordinates up to 1e6 and far beyond. Where a lattice coordinate f_o |x| passes 2^22 floats can no
  /// longer tell places within a cell apart, and that octave is constant in each cell or worse.
  void evaluate(const PointBatch& points, float* out) const;

  /// No |value| exceeds this but by rounding: the sum of w_o times the most one octave can reach, which would take
  /// eight corners pointing at one place with all their might. For billow = 0: 3.1 for one octave, 5.3 for six of gain
  /// 1/2.
  float bound() const { return bound_; }

  /// What the kernel needs to know of an octave.
  struct Octave {
    Vec3 row[3];  // from a point to its lattice coordinates less 1/2
    Vec3 offset;
    std::uint32_t seed;
    float linear, absolute;  // value += linear n + absolute |n|
  };

 private:
  std::array<Octave, kMaxFbmOctaves> octaves_;
  int count_;
  float constant_;  // the value of no octaves: minus the mean of the |n|
  float bound_;
};

/// FbmNoise(to_noise, settings).evaluate(local_points, out), for one-off use.
void fbm_noise(const PointBatch& local_points, const Affine& to_noise, const FbmSettings& settings, float* out);

}  // namespace brume
