// A sparse scalar voxel grid, laid out for fast trilinear look-ups.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <vector>

#include "renderer/core/bounds.h"
#include "renderer/core/error.h"
#include "renderer/core/large_array.h"
#include "renderer/media/brick_values.h"
#include "renderer/media/load_options.h"

namespace brume {

/// Integer index-space coordinates. Voxel i is centred at index i (OpenVDB's convention), so it covers [i-1/2, i+1/2].
using VoxelIndex = Vec3T<int>;

/// 8x8x8 voxels as they lie in a tree. Voxel (x,y,z) of the block is element (x * 8 + y) * 8 + z.
struct LeafBlock {
  static constexpr int kSize = 8, kVoxels = 512;
  VoxelIndex origin;                    ///< of voxel (0,0,0); multiples of 8
  std::array<std::uint64_t, 8> active;  ///< bit (e % 64) of word e / 64 for element e
  std::array<float, kVoxels> values;    ///< inactive voxels have values too

  bool is_active(int e) const { return active[static_cast<unsigned>(e) / 64] >> (e % 64) & 1; }
};

/// A cube of voxels that share one value.
struct TileBlock {
  VoxelIndex origin;  ///< multiples of 8
  int size;           ///< edge in voxels, a multiple of 8
  float value;
  bool active;
};

/// What a grid is built from. Everything not listed is 0. Where blocks overlap, leaves win over tiles and later ones
/// over earlier ones.
struct VoxelBlocks {
  LargeArray<LeafBlock> leaves;
  std::vector<TileBlock> tiles;
};

/// Bricks of 8^3 cells. Cell i lies between voxels i and i+1, and a brick stores the 9^3 voxels at all corners of its
/// cells, so that a look-up touches one brick only. A dense table over the active region maps a brick's place to where
/// its values begin; empty bricks share the first one, brick 0, and equal constant bricks share one.
///
/// Values are finite and >= 0: others were replaced by 0 and counted. Immutable; any thread.
class BrickGrid {
 public:
  static constexpr int kCells = BrickValues::kCells;
  static constexpr std::int64_t kMaxTableEntries = std::int64_t{1} << 27;  ///< 512 MiB of table
  /// Voxels along an axis: below this an index relative to the table keeps its fraction in float.
  static constexpr std::int64_t kMaxExtent = std::int64_t{1} << 23;

  /// Index of the voxel at the table's low corner; multiples of 8.
  VoxelIndex table_origin() const { return table_origin_; }
  /// Extent of the table in bricks.
  VoxelIndex table_extent() const { return table_extent_; }
  /// Of the brick at place (i,j,k) of the table, entry 1 + (i * extent.y + j) * extent.z + k, the first of its elements
  /// (see bytes_per_element()) among those of all bricks. Entry 0 is brick 0, for places outside.
  const std::uint32_t* table() const { return table_.data(); }
  const BrickValues& values() const { return values_; }
  int brick_count() const { return brick_count_; }  ///< with brick 0

  /// Index-space box outside which the trilinear interpolant is 0: [min-1, max+1] of the active voxels.
  Bounds3 support() const { return {Vec3d(active_min_) - Vec3d(1.0), Vec3d(active_max_) + Vec3d(1.0)}; }
  VoxelIndex active_min() const { return active_min_; }  ///< lowest active voxel along each axis
  VoxelIndex active_max() const { return active_max_; }  ///< highest one, inclusive

  float min_value() const { return min_value_; }  ///< of the active voxels, after replacement
  float max_value() const { return max_value_; }  ///< of all voxels, before they were rounded to their layout
  /// Upper bound of the interpolant inside a box of index space; whole bricks are looked at.
  float max_value(const Bounds3& box) const;
  std::uint64_t active_voxels() const { return active_voxels_; }
  std::uint64_t non_finite_voxels() const { return non_finite_voxels_; }  ///< were NaN or infinite, are 0
  std::uint64_t negative_voxels() const { return negative_voxels_; }      ///< were below 0, are 0
  std::size_t memory_bytes() const;

  /// The value of one voxel, 0 outside. Slow: for tests and tools.
  float voxel(VoxelIndex index) const;

 private:
  friend class BrickBuilder;
  std::size_t brick_at(std::int64_t entry) const {
    return table_[static_cast<std::size_t>(entry)] / elements_per_brick(values_.layout());
  }

  VoxelIndex table_origin_, table_extent_, active_min_, active_max_;
  std::vector<std::uint32_t> table_;
  BrickValues values_;
  std::vector<float> brick_max_;  // [brick_count]
  int brick_count_ = 0;
  float min_value_ = 0, max_value_ = 0;
  std::uint64_t active_voxels_ = 0, non_finite_voxels_ = 0, negative_voxels_ = 0;
};

/// Lays `blocks` out as bricks, on all hardware threads: as floats, or, unless options.full_precision, as half floats,
/// in the fastest layout where the bricks fit the machine's last cache and in the smallest where they do not. The
/// blocks are used up. A voxel's value is what OpenVDB's getValue() returns for a background of 0; voxels outside the
/// box of the active ones are 0. Errors: no active voxel; active voxels so far apart that the table would exceed
/// kMaxTableEntries or kMaxExtent; more memory needed than the machine has; cancelled.
Result<BrickGrid> build_brick_grid(VoxelBlocks blocks, const LoadOptions& options = {});

}  // namespace brume
