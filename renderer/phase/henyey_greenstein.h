#pragma once

#include "renderer/phase/phase_function.h"

namespace brume {

/// Henyey & Greenstein 1941, "Diffuse radiation in the Galaxy", equation 2:
///   p(c) = (1 - g^2) / (4 pi (1 + g^2 - 2 g c)^(3/2)),   g in [-0.999, 0.999], g > 0 forward.
class HenyeyGreenstein final : public PhaseFunction {
 public:
  explicit HenyeyGreenstein(float g);
  float value(float cos_theta) const override;
  PhaseSample sample(Vec3 direction, Vec2 u) const override;
  float mean_cosine() const override { return g_; }

 private:
  float g_;
};

}  // namespace brume
