#pragma once

#include <memory>

#include "renderer/media/brick_grid.h"
#include "renderer/media/shader.h"

namespace brume {

/// Density from a voxel grid, and emission from another grid (each with its own transform and resolution) where given.
class GridShader final : public Shader {
 public:
  struct Field {
    std::shared_ptr<const BrickGrid> grid;
    Affine index_from_scene;
  };

  /// @param density, emission  either may have no grid, not both.  @param voxel_size  world units, the smallest edge
  GridShader(Field density, Field emission, float voxel_size);

  ShaderTraits traits() const override;
  void density(const PointBatch& points, float* density) const override;
  float max_density(const Bounds3& box) const override;
  void emission(const PointBatch& points, float* emission) const override;

 private:
  Field density_, emission_;
  float voxel_size_;
};

}  // namespace brume
