#pragma once

#include "renderer/phase/phase_function.h"

namespace brume {

/// p = 1 / (4 pi).
class Isotropic final : public PhaseFunction {
 public:
  float value(float cos_theta) const override;
  void values(const float* cos_theta, int n, float* out) const override;
  PhaseSample sample(Vec3 direction, Vec2 u) const override;
  float mean_cosine() const override { return 0; }
};

}  // namespace brume
