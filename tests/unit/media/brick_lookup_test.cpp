#include "renderer/media/brick_lookup.h"

#include <gtest/gtest.h>
#include <openvdb/tools/Interpolation.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "tests/support/simd_levels.h"
#include "tests/unit/media/vdb_test_tools.h"

namespace brume {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
constexpr float kEps = std::numeric_limits<float>::epsilon();

/// Positions, padded as PointBatch asks for.
struct Points {
  std::vector<float> x, y, z;
  int n = 0;

  void add(Vec3 p) {
    x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
    ++n;
  }
  PointBatch batch(int first = 0, int count = -1) {
    for (auto* v : {&x, &y, &z}) v->resize(static_cast<std::size_t>(n) + 16, kNan);
    return {x.data() + first, y.data() + first, z.data() + first, count < 0 ? n - first : count, 0};
  }
  Vec3 operator[](int i) const {
    const auto k = static_cast<std::size_t>(i);
    return {x[k], y[k], z[k]};
  }
};

std::vector<float> look_up(const BrickGrid& grid, Points& points, const Affine& map = {}, float scale = 1) {
  std::vector<float> out(static_cast<std::size_t>(points.n) + 16, -1);
  lookup_trilinear(grid, map, points.batch(), scale, out.data());
  out.resize(static_cast<std::size_t>(points.n));
  return out;
}

BrickGrid bricks_of(const openvdb::FloatGrid& grid) {
  auto built = build_brick_grid(test::blocks_of(grid));
  EXPECT_TRUE(built.ok());
  return std::move(*built);
}

/// Each test runs at every SIMD level of this machine.
class BrickLookup : public AtSimdLevel {
 protected:
  /// Against OpenVDB at random positions in and round the grid.
  static void expect_equals_box_sampler(const openvdb::FloatGrid& reference, int n = 20000) {
    const BrickGrid grid = bricks_of(reference);
    const Bounds3 support = grid.support();
    std::mt19937 rng(5);
    std::uniform_real_distribution<double> u(0, 1);
    Points points;
    for (int i = 0; i < n; ++i) {
      Vec3d p;
      for (int axis = 0; axis < 3; ++axis) p[axis] = support.low[axis] - 3 + u(rng) * (support.extent()[axis] + 6);
      points.add(Vec3(p));
    }
    const auto found = look_up(grid, points);
    const auto accessor = reference.getConstAccessor();
    // A position is rounded once more when it is taken relative to the table (half an ulp of its extent, the values
    // change by at most max_value a voxel along each of three axes); the lerps add some ulps of the largest value.
    const double size = std::max({std::abs(support.low.x), std::abs(support.low.y), std::abs(support.low.z),
                                  support.extent().x, support.extent().y, support.extent().z}) +
                        16;
    const double tolerance = grid.max_value() * kEps * (4 + 3 * size);
    int inside = 0;
    for (int i = 0; i < points.n; ++i) {
      const Vec3 p = points[i];
      const float expected = openvdb::tools::BoxSampler::sample(accessor, openvdb::Vec3R(p.x, p.y, p.z));
      ASSERT_NEAR(found[static_cast<std::size_t>(i)], expected, tolerance) << p.x << ' ' << p.y << ' ' << p.z;
      inside += expected > 0;
    }
    EXPECT_GT(inside, n / 200);
  }
};

TEST_P(BrickLookup, EqualsBoxSamplerOnTheSmokeGrid) {
  expect_equals_box_sampler(*test::read_with_openvdb(test::kSmoke, "density"), 100000);
}

TEST_P(BrickLookup, EqualsBoxSamplerOnARandomSparseGrid) {
  for (unsigned seed = 1; seed < 4; ++seed) expect_equals_box_sampler(*test::random_grid(seed));
}

TEST_P(BrickLookup, EqualsBoxSamplerOnOneVoxel) {
  for (const openvdb::Coord at :
       {openvdb::Coord(0), openvdb::Coord(7), openvdb::Coord(8), openvdb::Coord(-1), openvdb::Coord(-1000, 3, 77)}) {
    auto grid = openvdb::FloatGrid::create(0.0f);
    grid->tree().setValue(at, 1.0f);
    expect_equals_box_sampler(*grid, 4000);
  }
}

TEST_P(BrickLookup, EqualsBoxSamplerOnOneLeaf) {
  auto grid = openvdb::FloatGrid::create(0.0f);
  std::mt19937 rng(2);
  std::uniform_real_distribution<float> u(0, 1);
  for (auto at = openvdb::CoordBBox(openvdb::Coord(-16, 8, 0), openvdb::Coord(-9, 15, 7)).begin(); at; ++at)
    grid->tree().setValue(*at, u(rng));
  expect_equals_box_sampler(*grid);
}

TEST_P(BrickLookup, EqualsBoxSamplerOnOneTile) {
  for (const openvdb::Index level : {1, 2}) {
    auto grid = openvdb::FloatGrid::create(0.0f);
    grid->tree().addTile(level, openvdb::Coord(-70, 3, 900), 0.75f, true);
    expect_equals_box_sampler(*grid);
  }
}

TEST_P(BrickLookup, GivesTheVoxelItselfOnVoxelPlanes) {
  const auto reference = test::random_grid(11);
  const BrickGrid grid = bricks_of(*reference);
  Points points;
  for (int x = -56; x <= 56; x += 3)
    for (int y = -56; y <= 56; y += 2)
      for (int z = -56; z <= 56; ++z)
        points.add(Vec3(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)));
  const auto found = look_up(grid, points);
  for (int i = 0; i < points.n; ++i) {
    const Vec3 p = points[i];
    ASSERT_EQ(found[static_cast<std::size_t>(i)],
              grid.voxel({static_cast<int>(p.x), static_cast<int>(p.y), static_cast<int>(p.z)}));
  }
}

TEST_P(BrickLookup, IsZeroOutsideAndForWhatIsNotANumber) {
  const BrickGrid grid = bricks_of(*test::read_with_openvdb(test::kSmoke, "density"));
  const Vec3 centre(grid.support().center());
  ASSERT_GT(grid.voxel(VoxelIndex(centre)), 0);
  const float far[] = {kNan,
                       -kNan,
                       kInf,
                       -kInf,
                       1e30f,
                       -1e30f,
                       3e9f,
                       -3e9f,
                       2147483648.0f,
                       -2147483648.0f,
                       8388608.0f,
                       -8388608.0f,
                       1e5f,
                       -1e5f,
                       std::numeric_limits<float>::max(),
                       std::numeric_limits<float>::lowest()};
  Points points;
  for (const float f : far)
    for (int axes = 1; axes < 8; ++axes) {
      Vec3 p = centre;
      for (int axis = 0; axis < 3; ++axis)
        if (axes >> axis & 1) p[axis] = f;
      points.add(p);
    }
  const Bounds3 support = grid.support();
  for (int axis = 0; axis < 3; ++axis)
    for (const bool high : {false, true}) {
      Vec3 p = centre;
      p[axis] = static_cast<float>(high ? support.high[axis] : support.low[axis]);
      points.add(p);
    }
  for (const float v : look_up(grid, points)) EXPECT_EQ(v, 0);
  Affine bad;
  bad.offset.y = kNan;
  for (const float v : look_up(grid, points, bad)) EXPECT_EQ(v, 0);
}

TEST_P(BrickLookup, NeverLeavesTheRangeOfTheVoxels) {
  const BrickGrid grid = bricks_of(*test::random_grid(4));
  std::mt19937 rng(9);
  std::uniform_real_distribution<float> u(-60, 60);
  Points points;
  for (int i = 0; i < 50000; ++i) points.add({u(rng), u(rng), u(rng)});
  for (const float v : look_up(grid, points)) {
    ASSERT_GE(v, 0);
    ASSERT_LE(v, grid.max_value() * (1 + 4 * kEps));
  }
}

TEST_P(BrickLookup, DoesNotDependOnHowABatchIsSplit) {
  const BrickGrid grid = bricks_of(*test::read_with_openvdb(test::kSmoke, "density"));
  const Bounds3 support = grid.support();
  std::mt19937 rng(3);
  std::uniform_real_distribution<float> u(-0.1f, 1.1f);
  Points points;
  for (int i = 0; i < 1000; ++i) {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis)
      p[axis] = static_cast<float>(support.low[axis] + u(rng) * support.extent()[axis]);
    points.add(p);
  }
  Affine map;
  map.row[0] = {0.9f, 0.1f, -0.05f};
  map.offset = {1.5f, -0.25f, 0.125f};
  const auto whole = look_up(grid, points, map, 1.7f);
  for (const int piece : {1, 3, 15, 16, 17, 63, 64, 65, 100}) {
    std::vector<float> out(1000 + 16, -1);
    for (int first = 0; first < 1000; first += piece)
      lookup_trilinear(grid, map, points.batch(first, std::min(piece, 1000 - first)), 1.7f, out.data() + first);
    ASSERT_EQ(std::memcmp(out.data(), whole.data(), whole.size() * sizeof(float)), 0) << piece;
  }
}

TEST_P(BrickLookup, WritesNoFurtherThanTheNextMultipleOf16) {
  const BrickGrid grid = bricks_of(*test::read_with_openvdb(test::kSmoke, "density"));
  for (int n = 0; n <= 130; ++n) {
    Points points;
    for (int i = 0; i < n; ++i) points.add(Vec3(grid.support().center()));
    const std::size_t end = (static_cast<std::size_t>(n) + 15) / 16 * 16;
    std::vector<float> out(end + 8, 1234.0f);
    lookup_trilinear(grid, Affine{}, points.batch(), 1, out.data());
    for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) ASSERT_GT(out[i], 0);
    for (std::size_t i = end; i < out.size(); ++i) ASSERT_EQ(out[i], 1234.0f) << n;
  }
}

TEST_P(BrickLookup, AppliesTheMapAndTheScale) {
  const auto reference = test::read_with_openvdb(test::kSmoke, "density");
  const BrickGrid grid = bricks_of(*reference);
  const Affined scene_from_index = translation({5, -7, 3}) * rotation_deg({30, 50, -20}) * scaling({0.03, -0.05, 0.02});
  const Affined map = inverse(scene_from_index).value();
  std::mt19937 rng(8);
  std::uniform_real_distribution<double> u(0, 1);
  Points points;
  for (int i = 0; i < 20000; ++i) {
    Vec3d p;
    for (int axis = 0; axis < 3; ++axis) p[axis] = grid.support().low[axis] + u(rng) * grid.support().extent()[axis];
    points.add(Vec3(scene_from_index.point(p)));
  }
  const auto found = look_up(grid, points, map.cast<float>(), 3.0f);
  const auto accessor = reference->getConstAccessor();
  for (int i = 0; i < points.n; ++i) {
    const Vec3d p = map.point(Vec3d(points[i]));
    const float expected = 3 * openvdb::tools::BoxSampler::sample(accessor, openvdb::Vec3R(p.x, p.y, p.z));
    // Index coordinates of some hundreds are sums of terms of that size in float.
    ASSERT_NEAR(found[static_cast<std::size_t>(i)], expected, 3 * grid.max_value() * 3 * 600 * kEps);
  }
}

TEST_P(BrickLookup, KeepsItsFractionFarFromTheOriginOfIndexSpace) {
  // The same leaf at the origin and a million voxels away; the scene is at home in both cases.
  constexpr int kFar = 1000000;
  const auto grid_at = [](int offset) {
    auto grid = openvdb::FloatGrid::create(0.0f);
    for (auto at = openvdb::CoordBBox(openvdb::Coord(0), openvdb::Coord(7)).begin(); at; ++at)
      grid->tree().setValue((*at).offsetBy(offset),
                            static_cast<float>(((*at).x() * 5 + (*at).y() * 3 + (*at).z()) % 7));
    return bricks_of(*grid);
  };
  const BrickGrid near = grid_at(0), far = grid_at(kFar);
  std::mt19937 rng(1);
  std::uniform_real_distribution<float> u(-0.2f, 1.1f);
  Points points;
  for (int i = 0; i < 5000; ++i) points.add({u(rng), u(rng), u(rng)});
  const Affined to_near = scaling({7, 7, 7}), to_far = translation(Vec3d(kFar + 0.0)) * to_near;
  const auto expected = look_up(near, points, to_near.cast<float>());
  const auto rounded_once = look_up(far, points, to_far.cast<float>());
  std::vector<float> in_double(static_cast<std::size_t>(points.n) + 16);
  lookup_trilinear(far, to_far, points.batch(), 1, in_double.data());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_NEAR(rounded_once[i], expected[i], 1e-4);
    ASSERT_NEAR(in_double[i], expected[i], 1e-4);
  }
}

TEST_P(BrickLookup, SeesACubeTheSameFrom26Sides) {
  // Optical depths through the centre of a cube, along the axes, face diagonals and space diagonals.
  for (const int edge : {1, 8, 16}) {
    auto reference = openvdb::FloatGrid::create(0.0f);
    reference->tree().fill(openvdb::CoordBBox(openvdb::Coord(0), openvdb::Coord(edge - 1)), 1.0f);
    const BrickGrid grid = bricks_of(*reference);
    const Vec3 centre(grid.support().center());
    double depth_of_class[4] = {-1, -1, -1, -1};
    for (int k = 0; k < 27; ++k) {
      const Vec3 way(static_cast<float>(k % 3 - 1), static_cast<float>(k / 3 % 3 - 1), static_cast<float>(k / 9 - 1));
      const int axes = static_cast<int>(dot(way, way));
      if (axes == 0) continue;
      Points points;
      constexpr int kSteps = 512;
      const float reach = static_cast<float>(edge);
      for (int i = -kSteps; i <= kSteps; ++i) points.add(centre + way * (reach * static_cast<float>(i) / kSteps));
      double depth = 0;
      for (const float v : look_up(grid, points)) depth += v;
      depth *= length(way) * reach / kSteps;
      double& first = depth_of_class[axes];
      if (first < 0) first = depth;
      EXPECT_NEAR(depth, first, 1e-5 * first) << edge << ": " << way.x << ' ' << way.y << ' ' << way.z;
    }
    // Along an axis: `edge` voxels of density 1, the two outer half voxels made up by the slopes outside.
    EXPECT_NEAR(depth_of_class[1], edge, 1e-4 * edge);
  }
}

INSTANTIATE_TEST_SUITE_P(Levels, BrickLookup, testing::ValuesIn(simd_levels()), simd_level_name);

}  // namespace
}  // namespace brume
