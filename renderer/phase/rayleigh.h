#pragma once

#include "renderer/phase/phase_function.h"

namespace brume {

/// Scattering by particles far smaller than the wavelength, unpolarised light (Rayleigh 1871):
///   p(c) = 3 (1 + c^2) / (16 pi).
class Rayleigh final : public PhaseFunction {
 public:
  float value(float cos_theta) const override;
  PhaseSample sample(Vec3 direction, Vec2 u) const override;
  float mean_cosine() const override { return 0; }
};

}  // namespace brume
