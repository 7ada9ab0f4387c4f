#pragma once

#include "renderer/phase/phase_function.h"

namespace brume {

/// Draine 2003, "Scattering by Interstellar Dust Grains. I": Henyey-Greenstein times a cosine squared,
///   p(c) = 1/(4 pi) (1 - g^2) / (1 + g^2 - 2 g c)^(3/2) (1 + alpha c^2) / (1 + alpha (1 + 2 g^2) / 3),
/// which is Henyey-Greenstein for alpha = 0 and Rayleigh for g = 0, alpha = 1.
/// g in [-0.9999, 0.9999], alpha >= 0.
class Draine final : public PhaseFunction {
 public:
  Draine(double g, double alpha);
  float value(float cos_theta) const override;
  PhaseSample sample(Vec3 direction, Vec2 u) const override;
  float mean_cosine() const override;

 private:
  double forward_share(double m) const;

  double g_, alpha_;
  double scale_;  // p(c) = scale / (2 pi) (1 + alpha c^2) / (...)^(3/2)
};

}  // namespace brume
