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

}  // namespace

Result<std::shared_ptr<const BrickGrid>> bake(const Shader& shader, Vec3d size, double voxel,
                                              const LoadOptions& options) {
  constexpr int kSize = LeafBlock::kSize;
  constexpr double kMostLeaves = 1 << 22;
  const auto leaves_along = [&](double length) { return std::floor(std::ceil(length / voxel) / kSize) + 1; };
  const double leaves = leaves_along(size.x) * leaves_along(size.y) * leaves_along(size.z);
  if (!(leaves < kMostLeaves))
    return bad_input("found voxels that are too small, expected larger ones: there would be " +
                     format_value(leaves * LeafBlock::kVoxels) + " in the volume's bounds");
  if (auto enough = check_memory(static_cast<std::uint64_t>(leaves) * sizeof(LeafBlock)); !enough)
    return enough.error();
  const int ny = static_cast<int>(leaves_along(size.y)), nz = static_cast<int>(leaves_along(size.z));

  VoxelBlocks blocks;
  std::vector<char> filled;
  try {
    blocks.leaves.resize(static_cast<std::size_t>(leaves));
    filled.resize(blocks.leaves.size());
  } catch (const std::bad_alloc&) {
    return bad_input("found voxels that are too small for the free memory, expected larger ones");
  }
  const bool complete = parallel_load(static_cast<std::int64_t>(leaves), options, 0, 0.8f, [&](std::int64_t number) {
    const auto i = static_cast<int>(number);
    const VoxelIndex origin{i / nz / ny * kSize, i / nz % ny * kSize, i % nz * kSize};
    const auto leaf = static_cast<std::size_t>(number);
    filled[leaf] = bake_leaf(shader, origin, voxel, blocks.leaves[leaf]) ? 1 : 0;
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
