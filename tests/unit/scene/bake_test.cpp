#include "renderer/media/bake.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/media/cloud_shader.h"
#include "renderer/sampling/sampler.h"
#include "tests/support/scenes.h"

namespace brume {
namespace {

const Bounds3 kBox{Vec3d(-1.1, -0.9, -0.5), Vec3d(1.1, 0.9, 0.7)};

Vec3d random_point(std::uint32_t i) {
  const Sampler random(SamplerKind::Independent, 12, 0, i);
  const Vec2 xy = random.u2(Decision::Pixel);
  const double z = double(random.u1(Decision::MarchOffset));
  const Vec3d size = kBox.high - kBox.low;
  return kBox.low + Vec3d(double(xy.x) * size.x, double(xy.y) * size.y, z * size.z);
}

TEST(Bake, VoxelsHoldTheDensityAtTheirPlaces) {
  const CloudShader cloud(translation(kBox.low), {});
  constexpr double kVoxel = 0.05;
  const auto grid = bake(cloud, kBox.high - kBox.low, kVoxel, {});
  ASSERT_TRUE(grid && *grid);
  int filled = 0;
  for (int x = 0; x <= 44; ++x)
    for (int y = 0; y <= 36; ++y)
      for (int z = 0; z <= 24; ++z) {
        alignas(64) float px[16] = {float(x * kVoxel)}, py[16] = {float(y * kVoxel)}, pz[16] = {float(z * kVoxel)},
                          d[16];
        cloud.density({px, py, pz, 1, 0}, d);
        ASSERT_NEAR((*grid)->voxel({x, y, z}), d[0], 0x1p-11f * d[0] + 1e-6f) << x << ' ' << y << ' ' << z;
        filled += d[0] > 0 ? 1 : 0;
      }
  EXPECT_GT(filled, 1000);
}

/// Density of the scene's only medium at points of its own space.
std::vector<float> densities(const Scene& scene, const Affined& world_from_local) {
  std::vector<float> out;
  for (std::uint32_t i = 0; i < 4000; ++i) {
    const Vec3 p(world_from_local.point(random_point(i)) - scene.origin);
    alignas(64) float x[16] = {p.x}, y[16] = {p.y}, z[16] = {p.z}, d[16];
    scene.media[0].shader->density({x, y, z, 1, 0}, d);
    out.push_back(d[0]);
  }
  return out;
}

/// @param baked_voxel  empty: not baked
Node cloud_scene(const std::string& baked_voxel = "") {
  Node scene = empty_scene();
  add_volume(scene, "cloud");
  set(scene, "volumes.0.bounds.min", "-1.1,-0.9,-0.5");
  set(scene, "volumes.0.bounds.max", "1.1,0.9,0.7");
  if (!baked_voxel.empty()) set(scene, "volumes.0.baked", "true"), set(scene, "volumes.0.baked_voxel", baked_voxel);
  return scene;
}

TEST(Bake, ABakedCloudIsTheCloudWhereverItStandsAndFinerVoxelsComeNearer) {
  const Affined wholes[] = {Affined(), translation({3, -2, 1}) * rotation_deg({20, 40, -70}) * scaling({2, 2, 2}),
                            rotation_deg({0, 0, 45}) * scaling({1, 1, 0.5}), translation({1e6, 2e6, 0})};
  for (const Affined& whole : wholes) {
    Node scene = cloud_scene();
    Numbers matrix;
    for (int i = 0; i < 3; ++i)
      matrix.insert(matrix.end(), {whole.row[i].x, whole.row[i].y, whole.row[i].z, whole.offset[i]});
    matrix.insert(matrix.end(), {0, 0, 0, 1});
    set(scene, "volumes.0.transform.matrix", format_value(matrix));
    const double longest = length(whole.axis(0)), shortest = length(whole.axis(2));
    const std::vector<float> exact = densities(*committed(scene), whole);
    set(scene, "volumes.0.baked", "true");
    double before = 1;
    for (const double voxel : {0.04, 0.01}) {
      set(scene, "volumes.0.baked_voxel", format_value(voxel * longest));
      const auto baked = committed(scene);
      EXPECT_TRUE(baked->needs.baked);
      EXPECT_GT(baked->grid_bytes(), 10000u);
      EXPECT_NEAR(*baked->media[0].traits.finest_scale, voxel * shortest, 1e-5);
      const std::vector<float> values = densities(*baked, whole);
      double squares = 0;
      for (std::size_t i = 0; i < values.size(); ++i) squares += std::pow(double(values[i]) - double(exact[i]), 2);
      const double error = std::sqrt(squares / static_cast<double>(values.size()));
      EXPECT_LT(error, 0.5 * before) << voxel;
      before = error;
    }
    EXPECT_LT(before, 0.03);
  }
}

TEST(Bake, OnlyWhatIsBakedIsBakedAgain) {
  int made = 0;
  BakeCache counted;
  const auto make = [&]() -> Result<std::shared_ptr<const BrickGrid>> {
    ++made;
    return bake(CloudShader(translation(kBox.low), {}), kBox.high - kBox.low, 0.1, {});
  };
  const BakeRecipe recipe{"cloud", {1.0, std::int64_t{2}}, kBox, 0.1};
  const auto a = counted.load(recipe, make), b = counted.load(recipe, make);
  EXPECT_EQ(made, 1);
  EXPECT_EQ(*a, *b);
  BakeRecipe other = recipe;
  other.values[1] = std::int64_t{3};
  EXPECT_TRUE(counted.load(other, make));
  other = recipe, other.voxel = 0.2;
  EXPECT_TRUE(counted.load(other, make));
  EXPECT_EQ(made, 3);
  counted.drop_unused();
  EXPECT_TRUE(counted.load(other, make));
  EXPECT_EQ(made, 4) << "what nobody holds is forgotten";
  EXPECT_TRUE(counted.load(recipe, make));
  EXPECT_EQ(made, 4) << "what somebody holds is kept";
}

TEST(Bake, NeitherAnotherLightNorAnotherPlaceBakesAgain) {
  SceneCache cache;
  Node scene = cloud_scene("0.05");
  const auto first = commit(scene, cache, {});
  ASSERT_TRUE(first);
  int baked = 0;
  const auto count = [&](float) { ++baked; };  // progress is only reported while something bakes
  add_light(scene, "point");
  for (int degrees = 0; degrees < 90; degrees += 7) {
    set(scene, "volumes.0.transform.rotate_deg", "20," + std::to_string(degrees) + ",10");
    ASSERT_TRUE(commit(scene, cache, {.progress = count}));
  }
  EXPECT_EQ(baked, 0);
  set(scene, "volumes.0.seed", "9");
  ASSERT_TRUE(commit(scene, cache, {.progress = count}));
  EXPECT_GT(baked, 0);
}

TEST(Bake, VoxelsThatDoNotFitAreRefusedAndAnEmptyCloudIsNot) {
  SceneCache cache;
  Node scene = cloud_scene("0.000001");
  const auto refused = commit(scene, cache, {});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().to_string().find("volumes.0.baked_voxel"), std::string::npos)
      << refused.error().to_string();
  set(scene, "volumes.0.baked_voxel", "auto");
  set(scene, "volumes.0.coverage", "0");
  const auto empty = commit(scene, cache, {});
  ASSERT_TRUE(empty);
  EXPECT_FALSE((*empty)->needs.baked);
}

}  // namespace
}  // namespace brume
