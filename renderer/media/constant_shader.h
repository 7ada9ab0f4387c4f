#pragma once

#include "renderer/media/shader.h"

namespace brume {

/// Density 1 everywhere: a homogeneous medium, for which one segment per stretch is exact.
class ConstantShader final : public Shader {
 public:
  ShaderTraits traits() const override { return {.constant = true, .own_emission = false, .finest_scale = {}}; }
  float max_density(const Bounds3&) const override { return 1; }
  void density(const PointBatch& points, float* density) const override;
};

}  // namespace brume
