#pragma once

#include <memory>

#include "renderer/media/brick_grid.h"
#include "renderer/media/shader.h"

namespace brume {

/// Density from a voxel grid, and emission from other grids where given: how much, how hot, or both. Each has its own
/// transform and resolution.
class GridShader final : public Shader {
 public:
  struct Field {
    std::shared_ptr<const BrickGrid> grid;
    Affine index_from_scene;
  };

  /// Emission is amount * blackbody_glow(scale * temperature + offset), each factor only where it has a grid; nothing
  /// where the temperature's grid is 0, which is its outside.
  struct Glow {
    Field amount, temperature;
    float scale = 1, offset = 0;  ///< K per value, K
  };

  /// @param density, glow  some field has a grid.  @param voxel_size  world units, the smallest edge
  GridShader(Field density, Glow glow, float voxel_size);

  ShaderTraits traits() const override;
  void density(const PointBatch& points, float* density) const override;
  float max_density(const Bounds3& box) const override;
  std::size_t memory_bytes() const override;
  void emission(const PointBatch& points, const EmissionBatch& emission) const override;

 private:
  Field density_;
  Glow glow_;
  float voxel_size_;
};

}  // namespace brume
