#include "renderer/media/brick_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/unit/media/vdb_test_tools.h"

namespace brume {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

LeafBlock leaf_at(VoxelIndex origin, float value, bool active) {
  LeafBlock leaf;
  leaf.origin = origin;
  leaf.active.fill(active ? ~std::uint64_t{0} : 0);
  leaf.values.fill(value);
  return leaf;
}

BrickGrid build(VoxelBlocks blocks) {
  auto built = build_brick_grid(std::move(blocks));
  EXPECT_TRUE(built.ok());
  return std::move(*built);
}

void expect_equals_openvdb(const openvdb::FloatGrid& reference) {
  const BrickGrid grid = build(test::blocks_of(reference));
  const openvdb::CoordBBox active = reference.evalActiveVoxelBoundingBox();
  EXPECT_EQ(grid.active_voxels(), reference.activeVoxelCount());
  EXPECT_EQ(grid.active_min(), VoxelIndex(active.min().x(), active.min().y(), active.min().z()));
  EXPECT_EQ(grid.active_max(), VoxelIndex(active.max().x(), active.max().y(), active.max().z()));
  const auto accessor = reference.getConstAccessor();
  openvdb::CoordBBox wide = active;
  wide.expand(10);
  for (auto at = wide.begin(); at; ++at) {
    const float expected = active.isInside(*at) ? accessor.getValue(*at) : 0.0f;
    ASSERT_EQ(grid.voxel({(*at).x(), (*at).y(), (*at).z()}), expected) << *at;
  }
}

TEST(BrickGrid, HoldsTheVoxelsOfTheSmokeGrid) {
  expect_equals_openvdb(*test::read_with_openvdb(test::kSmoke, "density"));
}

TEST(BrickGrid, HoldsTheVoxelsAndTilesOfARandomGrid) {
  for (unsigned seed = 0; seed < 3; ++seed) expect_equals_openvdb(*test::random_grid(seed));
}

TEST(BrickGrid, EveryBrickStoresTheFirstVoxelsOfTheNext) {
  const BrickGrid grid = build(test::blocks_of(*test::random_grid(7)));
  const VoxelIndex extent = grid.table_extent(), origin = grid.table_origin();
  std::size_t slot = 1;
  for (int bx = 0; bx < extent.x; ++bx)
    for (int by = 0; by < extent.y; ++by)
      for (int bz = 0; bz < extent.z; ++bz, ++slot) {
        const std::size_t brick = grid.table()[slot] / elements_per_brick(grid.values().layout());
        for (int e = 0; e < 729; ++e) {
          const VoxelIndex local(e / 81, e / 9 % 9, e % 9);
          ASSERT_EQ(grid.values().voxel(brick, local.x, local.y, local.z),
                    grid.voxel(origin + VoxelIndex(bx, by, bz) * 8 + local));
        }
      }
  EXPECT_EQ(grid.table()[0], 0);
}

TEST(BrickGrid, SupportIsOneVoxelWiderThanTheActiveBox) {
  VoxelBlocks blocks;
  LeafBlock leaf = leaf_at({-8, 0, 16}, 0, false);
  leaf.active[2] = std::uint64_t{1} << (3 * 8 + 4);  // voxel (2,3,4)
  leaf.values[2 * 64 + 3 * 8 + 4] = 5;
  blocks.leaves.push_back(leaf);
  const BrickGrid grid = build(std::move(blocks));
  EXPECT_EQ(grid.support().low, Vec3d(-7, 2, 19));
  EXPECT_EQ(grid.support().high, Vec3d(-5, 4, 21));
  EXPECT_EQ(grid.max_value(), 5);
  EXPECT_EQ(grid.min_value(), 5);
}

TEST(BrickGrid, InteriorOfATileSharesOneBrick) {
  VoxelBlocks blocks;
  blocks.tiles.push_back({{0, 0, 0}, 128, 0.5f, true});
  const BrickGrid grid = build(std::move(blocks));
  EXPECT_EQ(grid.active_voxels(), 128u * 128 * 128);
  EXPECT_EQ(grid.voxel({127, 127, 127}), 0.5f);
  EXPECT_EQ(grid.voxel({128, 127, 127}), 0.0f);
  // 17^3 places, of which only the 17^3 - 15^3 on the faces differ from each other; 15^3 inside share one.
  EXPECT_EQ(grid.brick_count(), 17 * 17 * 17 - 15 * 15 * 15 + 1 + 1);
}

TEST(BrickGrid, ConstantLeavesShareAsTilesDo) {
  VoxelBlocks blocks;
  for (int x = 0; x < 6; ++x)
    for (int y = 0; y < 6; ++y)
      for (int z = 0; z < 6; ++z) blocks.leaves.push_back(leaf_at({x * 8, y * 8, z * 8}, 2, true));
  const BrickGrid grid = build(std::move(blocks));
  EXPECT_EQ(grid.brick_count(), 7 * 7 * 7 - 5 * 5 * 5 + 1 + 1);
  EXPECT_EQ(grid.voxel({47, 0, 23}), 2);
}

TEST(BrickGrid, BadValuesBecomeZeroAndAreCounted) {
  VoxelBlocks blocks;
  LeafBlock leaf = leaf_at({0, 0, 0}, 1, true);
  leaf.values[0] = kNan, leaf.values[1] = kInf, leaf.values[2] = -kInf, leaf.values[3] = -0.25f;
  blocks.leaves.push_back(leaf);
  blocks.tiles.push_back({{8, 0, 0}, 8, -1, true});
  const BrickGrid grid = build(std::move(blocks));
  EXPECT_EQ(grid.non_finite_voxels(), 3u);
  EXPECT_EQ(grid.negative_voxels(), 1u + 512u);
  for (int z = 0; z < 4; ++z) EXPECT_EQ(grid.voxel({0, 0, z}), 0);
  EXPECT_EQ(grid.voxel({0, 0, 4}), 1);
  EXPECT_EQ(grid.voxel({8, 0, 0}), 0);
  EXPECT_EQ(grid.min_value(), 0);
  EXPECT_EQ(grid.max_value(), 1);
}

TEST(BrickGrid, InactiveValuesCountInsideTheActiveBoxOnly) {
  VoxelBlocks blocks;
  LeafBlock corner = leaf_at({0, 0, 0}, 3, false);
  corner.active[4] = std::uint64_t{1} << (4 * 8 + 4);  // voxel (4,4,4)
  LeafBlock far = leaf_at({32, 32, 32}, 7, false);
  far.active[0] = 1;  // voxel (32,32,32)
  blocks.leaves.push_back(corner);
  blocks.leaves.push_back(far);
  blocks.tiles.push_back({{0, 0, 8}, 8, 2, false});  // cut by the box
  blocks.tiles.push_back({{8, 8, 8}, 8, 4, false});  // inside it
  const BrickGrid grid = build(std::move(blocks));
  EXPECT_EQ(grid.active_voxels(), 2u);
  EXPECT_EQ(grid.voxel({4, 4, 4}), 3);
  EXPECT_EQ(grid.voxel({7, 7, 7}), 3);  // inactive, inside
  EXPECT_EQ(grid.voxel({3, 7, 7}), 0);  // inactive, outside
  EXPECT_EQ(grid.voxel({32, 32, 32}), 7);
  EXPECT_EQ(grid.voxel({33, 32, 32}), 0);
  EXPECT_EQ(grid.voxel({4, 4, 8}), 2);
  EXPECT_EQ(grid.voxel({3, 4, 8}), 0);
  EXPECT_EQ(grid.voxel({9, 9, 9}), 4);
}

TEST(BrickGrid, LeavesWinOverTiles) {
  VoxelBlocks blocks;
  blocks.tiles.push_back({{0, 0, 0}, 128, 1, true});
  blocks.leaves.push_back(leaf_at({64, 64, 64}, 9, true));
  const BrickGrid grid = build(std::move(blocks));
  EXPECT_EQ(grid.voxel({63, 64, 64}), 1);
  EXPECT_EQ(grid.voxel({64, 64, 64}), 9);
  EXPECT_EQ(grid.voxel({72, 71, 71}), 1);
}

TEST(BrickGrid, HeapsOfOverlappingTilesAreRefused) {
  VoxelBlocks blocks;
  for (int i = 0; i < 10; ++i) blocks.tiles.push_back({{0, 0, 0}, 128, 1, true});
  const auto built = build_brick_grid(std::move(blocks));
  ASSERT_FALSE(built.ok());
  EXPECT_NE(built.error().message.find("overlap"), std::string::npos);
}

TEST(BrickGrid, EmptyGridIsRefused) {
  const auto nothing = build_brick_grid({});
  ASSERT_FALSE(nothing.ok());
  EXPECT_NE(nothing.error().message.find("empty"), std::string::npos);
  VoxelBlocks inactive;
  inactive.leaves.push_back(leaf_at({0, 0, 0}, 1, false));
  EXPECT_FALSE(build_brick_grid(std::move(inactive)).ok());
}

TEST(BrickGrid, VoxelsTooFarApartAreRefused) {
  for (const int far : {1 << 14, 1 << 24, std::numeric_limits<int>::max() & ~7}) {
    VoxelBlocks blocks;
    blocks.leaves.push_back(leaf_at({0, 0, 0}, 1, true));
    blocks.leaves.push_back(leaf_at({far, far, far}, 1, true));
    const auto built = build_brick_grid(std::move(blocks));
    ASSERT_FALSE(built.ok());
    EXPECT_NE(built.error().message.find("134217728"), std::string::npos) << built.error().message;
  }
}

TEST(BrickGrid, BuildsAtBothEndsOfIndexSpace) {
  constexpr int kHigh = std::numeric_limits<int>::max() & ~7, kLow = std::numeric_limits<int>::min();
  VoxelBlocks high, low;
  high.leaves.push_back(leaf_at({kHigh, kHigh, kHigh}, 1, true));
  EXPECT_EQ(build(std::move(high)).voxel({kHigh + 7, kHigh, kHigh}), 1);
  low.leaves.push_back(leaf_at({kLow, kLow, kLow}, 1, true));  // its support begins one voxel before the first index
  EXPECT_FALSE(build_brick_grid(std::move(low)).ok());
}

TEST(BrickGrid, ProgressGrowsToOneAndCancellingStops) {
  const auto smoke = test::read_with_openvdb(test::kSmoke, "density");
  std::vector<float> reports;
  std::stop_source stop;
  LoadOptions options{[&](float p) { reports.push_back(p); }, stop.get_token()};
  ASSERT_TRUE(build_brick_grid(test::blocks_of(*smoke), options).ok());
  EXPECT_TRUE(std::is_sorted(reports.begin(), reports.end()));
  ASSERT_FALSE(reports.empty());
  EXPECT_EQ(reports.back(), 1.0f);

  options.progress = [&](float) { stop.request_stop(); };
  const auto cancelled = build_brick_grid(test::blocks_of(*smoke), options);
  ASSERT_FALSE(cancelled.ok());
  EXPECT_EQ(cancelled.error().code, ErrorCode::Cancelled);
}

TEST(BrickGrid, MemoryBeyondTheMachineIsRefusedBeforeItIsTaken) {
  EXPECT_TRUE(check_memory(1 << 20).ok());
  const auto refused = check_memory(std::uint64_t{1} << 60);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("GB"), std::string::npos);
}

}  // namespace
}  // namespace brume
