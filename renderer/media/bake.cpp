#include "renderer/media/bake.h"

#include <cmath>

namespace brume {
namespace {

/// Fills a leaf. @return whether any voxel is above 0
bool bake_leaf(const Shader& shader, VoxelIndex origin, double voxel, LeafBlock& leaf) {
  constexpr int kSize = LeafBlock::kSize, kVoxels = LeafBlock::kVoxels;
  alignas(64) float x[kVoxels], y[kVoxels], z[kVoxels];
  leaf.origin = origin;
  leaf.active = {};
  for (int e = 0; e < kVoxels; ++e) {
    x[e] = static_cast<float>((origin.x + e / (kSize * kSize)) * voxel);
    y[e] = static_cast<float>((origin.y + e / kSize % kSize) * voxel);
    z[e] = static_cast<float>((origin.z + e % kSize) * voxel);
  }
  shader.density({x, y, z, kVoxels, 0}, leaf.values.data());
  bool any = false;
  for (unsigned e = 0; e < kVoxels; ++e) {
    if (!(leaf.values[e] > 0)) continue;
    leaf.active[e / 64] |= std::uint64_t{1} << (e % 64);
    any = true;
  }
  return any;
}

int floor_to_leaf(double index) { return static_cast<int>(std::floor(index / LeafBlock::kSize)) * LeafBlock::kSize; }

}  // namespace

Result<std::shared_ptr<const BrickGrid>> bake(const Shader& shader, const Bounds3& box, double voxel,
                                              const LoadOptions& options) {
  constexpr double kMostLeaves = 1 << 22;  // along no axis more than the table of a grid may have
  const Vec3d size = (box.high - box.low) / voxel + Vec3d(2.0 * LeafBlock::kSize);
  const double leaves = size.x * size.y * size.z / LeafBlock::kVoxels;
  if (!(leaves < kMostLeaves) || std::max({size.x, size.y, size.z}) > static_cast<double>(BrickGrid::kMaxExtent))
    return bad_input("found voxels of " + format_value(voxel) + ", expected larger ones: these would be " +
                     format_value(leaves * LeafBlock::kVoxels) + " in the volume's bounds");
  if (auto enough = check_memory(static_cast<std::uint64_t>(leaves) * sizeof(LeafBlock)); !enough)
    return enough.error();

  const VoxelIndex low{floor_to_leaf(box.low.x / voxel), floor_to_leaf(box.low.y / voxel),
                       floor_to_leaf(box.low.z / voxel)};
  const auto count = [](double high, int from) {
    return (floor_to_leaf(std::ceil(high)) - from) / LeafBlock::kSize + 1;
  };
  const int nx = count(box.high.x / voxel, low.x), ny = count(box.high.y / voxel, low.y),
            nz = count(box.high.z / voxel, low.z);
  VoxelBlocks blocks;
  blocks.leaves.resize(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny) * static_cast<std::size_t>(nz));
  std::vector<char> filled(blocks.leaves.size());
  const bool complete = parallel_load(std::int64_t{nx} * ny, options, 0, 0.8f, [&](std::int64_t column) {
    constexpr int kSize = LeafBlock::kSize;
    const int x = static_cast<int>(column / ny), y = static_cast<int>(column % ny);
    for (int z = 0; z < nz; ++z) {
      const auto i = static_cast<std::size_t>(column * nz + z);
      const VoxelIndex origin{low.x + x * kSize, low.y + y * kSize, low.z + z * kSize};
      filled[i] = bake_leaf(shader, origin, voxel, blocks.leaves[i]) ? 1 : 0;
    }
  });
  if (!complete) return loading_cancelled();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < filled.size(); ++i)
    if (filled[i]) blocks.leaves[kept++] = blocks.leaves[i];
  blocks.leaves.resize(kept);
  if (kept == 0) return std::shared_ptr<const BrickGrid>();

  LoadOptions rest = part_of(options, 0.8f, 1);
  rest.full_precision = false;
  auto grid = build_brick_grid(std::move(blocks), rest);
  if (!grid) return grid.error();
  return std::make_shared<const BrickGrid>(std::move(*grid));
}

}  // namespace brume
