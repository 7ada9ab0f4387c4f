// The voxels of a grid's bricks, as they lie in memory.
#pragma once

#include <cstddef>
#include <cstdint>

#include "renderer/core/large_array.h"

namespace brume {

/// A brick holds the 9^3 voxels at the corners of its 8^3 cells; voxel (x,y,z) of it is number (x * 9 + y) * 9 + z.
/// Layouts and their costs: march_limit.md. What is looked up has the same bits in Half and in Quad.
enum class BrickLayout {
  Full,  ///< floats, in the order of their numbers; 2944 bytes
  Half,  ///< half floats in that order; 1472 bytes, the smallest
  Quad,  ///< half floats, [x8][y8][z9][4]: the voxels (x,y) (x,y+1) (x+1,y) (x+1,y+1) of each z side by side, so that
         ///< all corners of a cell are 16 bytes in a row; 4608 bytes, the fastest
};

const char* to_string(BrickLayout layout);

constexpr std::size_t bytes_per_brick(BrickLayout layout) {
  return layout == BrickLayout::Full ? 2944 : layout == BrickLayout::Half ? 1472 : 4608;  // whole cache lines
}

/// What look-ups count in: a float, a half float, four of them.
constexpr std::size_t bytes_per_element(BrickLayout layout) {
  return layout == BrickLayout::Full ? 4 : layout == BrickLayout::Half ? 2 : 8;
}
constexpr std::size_t elements_per_brick(BrickLayout layout) {
  return bytes_per_brick(layout) / bytes_per_element(layout);
}

/// Bricks of one layout. Half floats hold a value over unit(), a power of two that makes the most of their range:
/// values that half floats can hold stay exact, others are off by 2^-11 of themselves at most, or by 2^-28 times the
/// largest.
class BrickValues {
 public:
  static constexpr int kCells = 8;    ///< along an edge of a brick
  static constexpr int kCorners = 9;  ///< voxels along an edge
  static constexpr int kVoxels = kCorners * kCorners * kCorners;
  static constexpr float kLargestInHalves = 0x1p28f;  ///< beyond this, factors of look-ups would overflow

  BrickValues() = default;
  /// All voxels of brick 0 are 0; the others are to be stored. Throws std::bad_alloc.
  /// @param largest  voxel of all, > 0 unless all are 0
  BrickValues(BrickLayout layout, std::size_t bricks, float largest);

  /// Different bricks at the same time.  @param voxels  [9^3], >= 0.  @return the largest as it is held
  float store(std::size_t brick, const float* voxels);

  /// Slow: for tests and tools.
  float voxel(std::size_t brick, int x, int y, int z) const;

  BrickLayout layout() const { return layout_; }
  std::size_t bytes() const { return bricks_ * bytes_per_brick(layout_); }
  float unit() const { return unit_; }

  /// 64-byte aligned; of type float or std::uint16_t, and readable 64 bytes behind the end.
  const std::byte* data() const { return data_.data(); }

 private:
  BrickLayout layout_ = BrickLayout::Full;
  std::size_t bricks_ = 0;
  float unit_ = 1;
  LargeArray<std::byte> data_;
};

}  // namespace brume
