#include "renderer/media/constant_shader.h"

#include <algorithm>

#include "renderer/media/registry.h"

namespace brume {

void ConstantShader::density(const PointBatch& points, float* density) const { std::fill_n(density, points.n, 1.0f); }

ShaderType homogeneous_shader_type() {
  return {"homogeneous",
          "Homogeneous",
          "The same everywhere inside the bounds.",
          {},
          false,
          [](const Node&, const ShaderContext&) -> Result<MadeShader> {
            return MadeShader{std::make_shared<ConstantShader>()};
          }};
}

}  // namespace brume
