#pragma once

#include "renderer/phase/phase_function.h"

namespace brume {

/// Henyey & Greenstein 1941, "Diffuse radiation in the Galaxy", equation 2:
///   p(c) = (1 - g^2) / (4 pi (1 + g^2 - 2 g c)^(3/2)),   g in [-0.9999, 0.9999], g > 0 forward.
class HenyeyGreenstein final : public PhaseFunction {
 public:
  /// @param g  clamped to the range
  explicit HenyeyGreenstein(double g);
  float value(float cos_theta) const override;
  void values(const float* cos_theta, int n, float* out) const override;
  PhaseSample sample(Vec3 direction, Vec2 u) const override;
  float mean_cosine() const override { return static_cast<float>(g_); }

 private:
  double g_;
  float least_, slope_, scale_;  // p(c) = scale / (least + slope (1 - c sign g))^(3/2)
};

}  // namespace brume
