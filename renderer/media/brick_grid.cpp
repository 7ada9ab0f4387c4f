#include "renderer/media/brick_grid.h"

#include <algorithm>
#include <cmath>

namespace brume {

std::size_t BrickGrid::memory_bytes() const { return table_.size() * sizeof(std::uint32_t) + values_.bytes(); }

float BrickGrid::max_value(const Bounds3& box) const {
  std::int64_t first[3], last[3];
  for (int axis = 0; axis < 3; ++axis) {
    const auto place = [&](double at) { return std::floor((at - table_origin_[axis]) / kCells); };
    const double end = table_extent_[axis] - 1;
    first[axis] = static_cast<std::int64_t>(std::clamp(place(box.low[axis]), 0.0, end + 1));
    last[axis] = static_cast<std::int64_t>(std::clamp(place(box.high[axis]), -1.0, end));
  }
  const bool whole = first[0] == 0 && first[1] == 0 && first[2] == 0 && last[0] == table_extent_.x - 1 &&
                     last[1] == table_extent_.y - 1 && last[2] == table_extent_.z - 1;
  if (whole) return *std::max_element(brick_max_.begin(), brick_max_.end());
  float largest = 0;
  for (std::int64_t x = first[0]; x <= last[0]; ++x)
    for (std::int64_t y = first[1]; y <= last[1]; ++y)
      for (std::int64_t z = first[2]; z <= last[2]; ++z) {
        const std::int64_t at = 1 + (x * table_extent_.y + y) * table_extent_.z + z;
        largest = std::max(largest, brick_max_[brick_at(at)]);
      }
  return largest;
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
  return values_.voxel(brick_at(at), local[0], local[1], local[2]);
}

}  // namespace brume
