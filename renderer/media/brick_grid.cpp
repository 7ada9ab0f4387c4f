#include "renderer/media/brick_grid.h"

namespace brume {

std::size_t BrickGrid::memory_bytes() const {
  return table_.size() * sizeof(std::int32_t) + static_cast<std::size_t>(brick_count_) * kBrickFloats * sizeof(float);
}

float BrickGrid::voxel(VoxelIndex index) const {
  std::int64_t place[3];
  int local[3];
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t relative = std::int64_t{index[axis]} - table_origin_[axis];
    place[axis] = relative >> 3;  // rounds down
    local[axis] = static_cast<int>(relative & 7);
    if (place[axis] < 0 || place[axis] >= table_extent_[axis]) return 0;
  }
  const std::int64_t at = 1 + (place[0] * table_extent_.y + place[1]) * table_extent_.z + place[2];
  const std::int64_t brick = table_[static_cast<std::size_t>(at)];
  return values_[static_cast<std::size_t>(brick * kBrickFloats + (local[0] * kCorners + local[1]) * kCorners +
                                          local[2])];
}

}  // namespace brume
