// Which way light goes on after it is scattered.
#pragma once

#include <memory>

#include "renderer/core/vec.h"

namespace brume {

struct PhaseSample {
  Vec3 direction;  ///< unit
  float pdf_w;     ///< per sr; equals the phase function there, so the sample's weight is 1
};

/// A normalised phase function p(cos theta), 1/sr, of the cosine between the directions of travel before and after.
/// Forward scattering has cos theta near 1. Immutable; any thread.
class PhaseFunction {
 public:
  virtual ~PhaseFunction() = default;

  /// @param cos_theta in [-1, 1]; rounding beyond is clamped.   @return 1/sr, finite
  virtual float value(float cos_theta) const = 0;

  /// value() of n cosines, to some float roundings. Arrays are those of an Arena: written in whole vectors.
  virtual void values(const float* cos_theta, int n, float* out) const {
    for (int i = 0; i < n; ++i) out[i] = value(cos_theta[i]);
  }

  /// Draws the direction of travel after scattering, with pdf value(). @param direction of travel before, unit.
  virtual PhaseSample sample(Vec3 direction, Vec2 u) const = 0;

  /// Integral of cos theta * value, in (-1, 1).
  virtual float mean_cosine() const = 0;
};

}  // namespace brume
