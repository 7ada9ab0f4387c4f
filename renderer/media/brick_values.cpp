#include "renderer/media/brick_values.h"

#include <half.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace brume {
namespace {

constexpr int kQuadElements = BrickValues::kCells * BrickValues::kCells * BrickValues::kCorners * 4;

static_assert(bytes_per_brick(BrickLayout::Full) >= BrickValues::kVoxels * 4 &&
              bytes_per_brick(BrickLayout::Half) >= BrickValues::kVoxels * 2 &&
              bytes_per_brick(BrickLayout::Quad) == kQuadElements * 2);

int number(int x, int y, int z) { return (x * BrickValues::kCorners + y) * BrickValues::kCorners + z; }

}  // namespace

const char* to_string(BrickLayout layout) {
  switch (layout) {
    case BrickLayout::Full:
      return "full";
    case BrickLayout::Half:
      return "half";
    case BrickLayout::Quad:
      return "quad";
  }
  return "";
}

BrickValues::BrickValues(BrickLayout layout, std::size_t bricks, float largest) : layout_(layout), bricks_(bricks) {
  // The largest value becomes one in [2^14, 2^15): rounding cannot take it out of the range of a half float.
  if (layout != BrickLayout::Full && largest > 0) unit_ = std::ldexp(1.0f, std::max(std::ilogb(largest) - 14, -125));
  data_.resize(bytes() + 64);
  std::memset(data_.data(), 0, bytes_per_brick(layout));
}

float BrickValues::store(std::size_t brick, const float* voxels) {
  std::byte* const to = data_.data() + brick * bytes_per_brick(layout_);
  if (layout_ == BrickLayout::Full) {
    std::memcpy(to, voxels, kVoxels * sizeof(float));
    return *std::max_element(voxels, voxels + kVoxels);
  }
  std::uint16_t halves[kVoxels], largest = 0;
  for (int i = 0; i < kVoxels; ++i) {
    halves[i] = half(voxels[i] / unit_).bits();
    largest = std::max(largest, halves[i]);
  }
  if (layout_ == BrickLayout::Half) {
    std::memcpy(to, halves, sizeof(halves));
  } else {
    std::uint16_t quads[kQuadElements], *quad = quads;
    for (int x = 0; x < kCells; ++x)
      for (int y = 0; y < kCells; ++y)
        for (int z = 0; z < kCorners; ++z, quad += 4)
          for (int corner = 0; corner < 4; ++corner) quad[corner] = halves[number(x + corner / 2, y + corner % 2, z)];
    std::memcpy(to, quads, sizeof(quads));
  }
  half held;
  held.setBits(largest);
  return static_cast<float>(held) * unit_;
}

float BrickValues::voxel(std::size_t brick, int x, int y, int z) const {
  const std::byte* const from = data_.data() + brick * bytes_per_brick(layout_);
  if (layout_ == BrickLayout::Full) {
    float value;
    std::memcpy(&value, from + number(x, y, z) * 4, sizeof(value));
    return value;
  }
  int element = number(x, y, z);
  if (layout_ == BrickLayout::Quad) {
    const int cell_x = std::min(x, kCells - 1), cell_y = std::min(y, kCells - 1);
    element = ((cell_x * kCells + cell_y) * kCorners + z) * 4 + 2 * (x - cell_x) + (y - cell_y);
  }
  std::uint16_t bits;
  std::memcpy(&bits, from + element * 2, sizeof(bits));
  half held;
  held.setBits(bits);
  return static_cast<float>(held) * unit_;
}

}  // namespace brume
