// The layouts of bricks: what half floats keep of the voxels, and that all layouts are looked up alike.
#include "renderer/media/brick_values.h"

#include <gtest/gtest.h>

#include <random>

#include "renderer/core/simd.h"
#include "renderer/media/brick_lookup.h"
#include "tests/unit/media/vdb_test_tools.h"

namespace brume {
namespace {

std::vector<float> random_voxels(float largest) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<float> u(0, largest);
  std::vector<float> voxels(BrickValues::kVoxels);
  for (float& v : voxels) v = u(rng);
  voxels[17] = 0, voxels[18] = largest, voxels[19] = 1e-3f * largest;
  return voxels;
}

TEST(BrickValues, HalfFloatsAreOffByARoundingOfElevenBits) {
  for (const BrickLayout layout : {BrickLayout::Full, BrickLayout::Half, BrickLayout::Quad})
    for (const float largest : {1.0f, 0.37f, 1e-20f, 2e8f}) {
      BrickValues values(layout, 3, largest);
      const std::vector<float> voxels = random_voxels(largest);
      const float held = values.store(2, voxels.data());
      float most = 0;
      for (int e = 0; e < BrickValues::kVoxels; ++e) {
        const double exact = double(voxels[static_cast<std::size_t>(e)]);
        const float kept = values.voxel(2, e / 81, e / 9 % 9, e % 9);
        const double rounding = layout == BrickLayout::Full ? 0 : 0x1p-11 * exact + 0x1p-28 * double(largest);
        ASSERT_NEAR(double(kept), exact, rounding) << to_string(layout) << ", voxel " << e;
        ASSERT_EQ(values.voxel(0, e / 81, e / 9 % 9, e % 9), 0);
        most = std::max(most, kept);
      }
      EXPECT_EQ(held, most) << "the bound of the brick is what it holds";
    }
}

TEST(BrickValues, ValuesThatHalfFloatsHoldStayExact) {
  BrickValues values(BrickLayout::Quad, 2, 3.0f);
  std::vector<float> voxels(BrickValues::kVoxels);
  for (std::size_t e = 0; e < voxels.size(); ++e) voxels[e] = static_cast<float>(e) / 256;
  static_cast<void>(values.store(1, voxels.data()));
  for (int e = 0; e < BrickValues::kVoxels; ++e)
    ASSERT_EQ(values.voxel(1, e / 81, e / 9 % 9, e % 9), voxels[static_cast<std::size_t>(e)]);
}

TEST(BrickValues, LookUpsInHalfFloatsAreThoseInFloatsButForTheirRounding) {
  const auto reference = test::read_with_openvdb(test::kSmoke, "density");
  // A voxel of -0 must not be taken for its bits.
  reference->tree().setValue(reference->evalActiveVoxelBoundingBox().min(), -0.0f);
  const BrickGrid full = build_brick_grid(test::blocks_of(*reference), {.full_precision = true}).value();
  const BrickGrid half = build_brick_grid(test::blocks_of(*reference), {.full_precision = false}).value();
  ASSERT_EQ(half.values().layout(), BrickLayout::Quad);
  constexpr int kN = 4096;
  std::vector<float> p[3], exact(kN), rounded(kN);
  std::mt19937 rng(5);
  for (int axis = 0; axis < 3; ++axis) {
    std::uniform_real_distribution<float> u(static_cast<float>(full.support().low[axis]) - 2,
                                            static_cast<float>(full.support().high[axis]) + 2);
    for (int i = 0; i < kN; ++i) p[axis].push_back(u(rng));
  }
  for (const std::string& level : simd_levels()) {
    ASSERT_TRUE(force_simd_level(level).ok());
    const PointBatch points{p[0].data(), p[1].data(), p[2].data(), kN, 0};
    lookup_trilinear(full, Affine{}, points, 1, exact.data());
    lookup_trilinear(half, Affine{}, points, 1, rounded.data());
    for (std::size_t i = 0; i < kN; ++i)
      ASSERT_NEAR(rounded[i], exact[i], 0x1p-11f * exact[i] + 1e-6f * full.max_value()) << level;
  }
  ASSERT_TRUE(force_simd_level("auto").ok());
}

}  // namespace
}  // namespace brume
