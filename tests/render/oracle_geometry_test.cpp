// O9 and O10 of the catalogue: voxel grids from all sides, and under any affine map. (O10 of analytic media is in
// invariance_test.cpp, O11 in oracle_inside_test.cpp.)
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/support/effort.h"
#include "tests/support/scenes.h"
#include "tests/unit/media/vdb_test_tools.h"

namespace brume {
namespace {

/// A signed permutation of the axes: one of the 48 symmetries of the cube.
struct Symmetry {
  int axis[3];
  float sign[3];
  Vec3 operator()(Vec3 p) const { return {sign[0] * p[axis[0]], sign[1] * p[axis[1]], sign[2] * p[axis[2]]}; }
};

std::vector<Symmetry> symmetries() {
  std::vector<Symmetry> all;
  constexpr int kOrders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (const auto& order : kOrders)
    for (int signs = 0; signs < 8; ++signs)
      all.push_back({{order[0], order[1], order[2]},
                     {signs & 1 ? -1.0f : 1.0f, signs & 2 ? -1.0f : 1.0f, signs & 4 ? -1.0f : 1.0f}});
  return all;
}

constexpr double kVoxel = 0.1;

/// A cube of voxels of density 1, stored in different ways. Interpolated linearly, it is 1 as far as `flat` from its
/// middle along an axis, and 0 from flat + 1 on (in voxels).
struct Cube {
  const char* name;
  openvdb::FloatGrid::Ptr grid;
  double middle, flat;  ///< in voxels
};

std::vector<Cube> cubes() {
  openvdb::initialize();
  std::vector<Cube> all;
  const auto add = [&](const char* name, double middle, double flat) {
    auto grid = openvdb::FloatGrid::create(0.0f);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(kVoxel));
    all.push_back({name, test::named(grid), middle, flat});
    return grid;
  };
  add("voxel", 0, 0)->tree().setValue(openvdb::Coord(0, 0, 0), 1.0f);
  add("leaf", 3.5, 3.5)->tree().fill(openvdb::CoordBBox::createCube(openvdb::Coord(0), 8), 1.0f);
  all.back().grid->tree().voxelizeActiveTiles();
  add("tile", 3.5, 3.5)->tree().addTile(1, openvdb::Coord(0), 1.0f, true);
  add("large_tile", 63.5, 63.5)->tree().addTile(2, openvdb::Coord(0), 1.0f, true);
  return all;
}

/// The cube with its middle in the origin, an optical depth of about 2 across it, and a white background.
Node scene_of(const Cube& cube, const char* integrator) {
  Node scene = empty_scene();
  set(scene, "render.integrator", integrator);
  set(scene, "render.sampler", "independent");
  Node& v = add_volume(scene, "vdb");
  set(v, "file", test::write_vdb(std::string("oracle_") + cube.name + ".vdb", {cube.grid}));
  set(v, "albedo", "0,0,0");
  set(v, "density_scale", format_value(2 / ((2 * cube.flat + 1) * kVoxel)));
  set(v, "transform.translate", format_value(Numbers(3, -cube.middle * kVoxel)));
  if (scene.child("render").table().find("step_size")) set(scene, "render.step_size", format_value(kVoxel / 8));
  set(add_light(scene, "environment"), "radiance", "1,1,1");
  return scene;
}

TEST(OracleGeometry, O9TheCubesAreStoredInTheWaysTheyAreNamed) {
  const auto all = cubes();
  EXPECT_EQ(all[0].grid->tree().leafCount(), 1u);
  EXPECT_EQ(all[0].grid->tree().activeVoxelCount(), 1u);
  EXPECT_EQ(all[1].grid->tree().leafCount(), 1u);
  EXPECT_EQ(all[1].grid->tree().activeVoxelCount(), 512u);
  for (const std::size_t tile : {2, 3}) {
    EXPECT_EQ(all[tile].grid->tree().leafCount(), 0u) << all[tile].name;
    EXPECT_EQ(all[tile].grid->tree().activeTileCount(), 1u) << all[tile].name;
  }
}

/// Directions through the middles of faces, edges and corners: their images under the symmetries are all 26; and one
/// that has no symmetry.
const Vec3 kViews[] = {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 2, 3}};

/// Parallel rays that make a picture of size x size: half a voxel apart where the cube is small, so that they lie in
/// the planes of voxels and in those between them, and on the border of what is interpolated.
std::vector<Ray> picture(const Cube& cube, Vec3 view) {
  constexpr int kSize = 11;
  const Vec3 d = normalize(view), u = normalize(cross(d, Vec3(1, 0, 0))), v = cross(d, u);
  const float reach = static_cast<float>(kVoxel * (cube.flat + 1));
  const float spacing = reach * 2 / (kSize - 1);
  std::vector<Ray> rays;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const Vec3 across =
          u * (static_cast<float>(x - kSize / 2) * spacing) + v * (static_cast<float>(y - kSize / 2) * spacing);
      rays.push_back({across - d * (4 * reach), d});
    }
  return rays;
}

TEST(OracleGeometry, O9ACubeLooksTheSameFromAllItsSidesEdgesAndCorners) {
  for (const Cube& cube : cubes()) {
    const auto scene = committed(scene_of(cube, "decoupled"));
    double largest = 0;
    int met = 0;
    for (const Vec3 view : kViews)
      for (const Ray& ray : picture(cube, view)) {
        const double first = estimate(*scene, ray, 1).mean();
        met += first < 0.999;
        for (const Symmetry& turned : symmetries()) {
          const RayEstimate e = estimate(*scene, {turned(ray.origin), turned(ray.direction)}, 1);
          ASSERT_EQ(e.non_finite, 0u);
          largest = std::max(largest, std::abs(e.mean() - first));
        }
      }
    std::printf("%-10s largest difference of transmittance between symmetric rays %.1e\n", cube.name, largest);
    // Positions are rounded to 1e-7 of the distance from the camera, which is some 4 to 8 cubes long.
    EXPECT_LT(largest, 2e-5) << cube.name;
    EXPECT_GT(met, 100) << cube.name;
  }
}

TEST(OracleGeometry, O9ALeafAndATileOfTheSameVoxelsAreTheSamePicture) {
  const auto all = cubes();
  const auto leaf = committed(scene_of(all[1], "decoupled")), tile = committed(scene_of(all[2], "decoupled"));
  for (const Vec3 view : kViews)
    for (const Ray& ray : picture(all[1], view))
      ASSERT_EQ(estimate(*leaf, ray, 1).mean(), estimate(*tile, ray, 1).mean());
}

// Through the middle along an axis, an edge's diagonal or a corner's (k = 1, 2, 3 axes), the interpolated density is a
// product of k equal trapezia: its integral is sqrt(k) (2 flat + 2 / (k + 1)) voxels. Tracking walks its cells of
// majorants exactly through their edges and corners (G5).
TEST(OracleGeometry, O9TheColumnThroughTheMiddleIsRightFromAll26Directions) {
  const double bound = sidak_z(1e-3, 4 * 2 * 26);
  for (const Cube& cube : cubes())
    for (const char* integrator : {"decoupled", "delta_tracking", "delta_tracking_local"}) {
      const bool marches = std::string(integrator) == "decoupled";
      const auto scene = committed(scene_of(cube, integrator));
      for (int code = 0; code < 27; ++code) {
        const Vec3 way(static_cast<float>(code % 3 - 1), static_cast<float>(code / 3 % 3 - 1),
                       static_cast<float>(code / 9 - 1));
        const int axes = static_cast<int>(std::lround(dot(way, way)));
        if (axes == 0) continue;
        const double column = std::sqrt(axes) * (2 * cube.flat + 2.0 / (axes + 1)) / (2 * cube.flat + 1);
        const Vec3 d = normalize(way);
        const float distance = static_cast<float>(4 * kVoxel * (cube.flat + 1));
        const Ray ray{d * -distance, d};
        const RayEstimate e =
            estimate(*scene, ray, marches ? 512 : 20000 / kFewer, 1, static_cast<std::uint32_t>(code));
        const double expected = std::exp(-2 * column);
        const std::string what = std::string(cube.name) + ", " + integrator + ", direction " + std::to_string(code);
        // The depth of the single voxel is off by up to 0.005 at an eighth of a voxel, and on average over the offsets
        // by 0; what is left of 512 of them is 1e-4, and the bias of the exponential 3e-6.
        if (marches)
          EXPECT_NEAR(e.mean() / expected, 1, 5e-4) << what;
        else
          EXPECT_LT(std::abs(z_score(e, expected)), bound) << what << ": " << e.mean() << ", not " << expected;
      }
    }
}

// ---- O10 ------------------------------------------------------------------------------------------------------------

std::string matrix_text(const Affined& m) {
  Numbers n;
  for (int i = 0; i < 3; ++i) n.insert(n.end(), {m.row[i].x, m.row[i].y, m.row[i].z, m.offset[i]});
  n.insert(n.end(), {0, 0, 0, 1});
  return format_value(n);
}

Node plume(const char* integrator, const Affined& map, double step) {
  Node scene = empty_scene();
  set(scene, "render.integrator", integrator);
  set(scene, "render.sampler", "independent");
  Node& v = add_volume(scene, "vdb");
  set(v, "file", test::kSmoke);
  set(v, "albedo", "0,0,0");
  set(v, "density_scale", "2");
  set(v, "transform.matrix", matrix_text(map));
  if (scene.child("render").table().find("step_size")) set(scene, "render.step_size", format_value(step));
  set(add_light(scene, "environment"), "radiance", "1,1,1");
  return scene;
}

/// From outside through a random point of the smoke.
std::pair<Vec3d, Vec3d> line_through_the_smoke(std::uint32_t i) {
  const Sampler random(SamplerKind::Independent, 3, i, 0);
  const auto number = [&](int k) { return double(random.u1(Decision::Pixel, k)); };
  const Vec3d target(0.6 + 0.9 * number(0), 0.4 + 0.9 * number(1), 0.3 + 2.4 * number(2));
  const Vec3d direction = normalize(Vec3d(number(3) - 0.5, number(4) - 0.5, number(5) - 0.5));
  return {target - direction * 6.0, direction};
}

// A map that carries the smoke along and stretches a line by |A d| stretches the optical depth of that line as much.
TEST(OracleGeometry, O10AGridUnderAnyAffineMapHasTheDepthOfTheLengthInTheWorld) {
  const Affined shear{{{1, 0.7, -0.3}, {0, 1, 0.5}, {0, 0, 1}}, {0.2, -0.1, 0.3}};
  const std::pair<const char*, Affined> maps[] = {
      {"scaled", scaling({3, 3, 3})},
      {"scaled unequally", scaling({2, 0.4, 1})},
      {"turned", rotation_deg({25, 60, -100})},
      {"mirrored", scaling({1, -1, 1})},
      {"sheared", shear},
      {"all at once", translation({2, 1, -1}) * rotation_deg({5, 60, 20}) * shear * scaling({-2, 0.5, 1})},
      {"a million away", translation({1e6, 1e6, -1e6}) * rotation_deg({5, 60, 20}) * shear * scaling({-2, 0.5, 1})}};
  constexpr int kRays = 60, kTracked = 6;
  const double bound = sidak_z(1e-3, static_cast<int>(std::size(maps)) * kTracked);
  const auto as_it_is = committed(plume("decoupled", {}, 0.004));
  for (const auto& [what, map] : maps) {
    const auto marched = committed(plume("decoupled", map, 0.004)),
               tracked = committed(plume("null_scattering", map, 0));
    double largest = 0;
    int met = 0;
    for (std::uint32_t i = 0; i < kRays; ++i) {
      const auto [from, direction] = line_through_the_smoke(i);
      const double depth = -std::log(estimate(*as_it_is, {Vec3(from), Vec3(direction)}, 1).mean());
      const Vec3d way = map.vector(direction), start = map.point(from) - marched->origin;
      const Ray ray{Vec3(start), Vec3(normalize(way))};
      const double expected = std::exp(-depth * length(way));
      const double seen = estimate(*marched, ray, 1).mean();
      largest = std::max(largest, std::abs(seen - expected));
      met += depth > 0.1;
      EXPECT_NEAR(seen, expected, 1e-3) << what << ", ray " << i;
      if (i >= kTracked) continue;
      const RayEstimate e = estimate(*tracked, ray, 20000 / kFewer);
      EXPECT_LT(std::abs(e.mean() - expected), bound * e.standard_error() + 1e-3) << what << ", tracked ray " << i;
    }
    std::printf("%-16s largest difference of transmittance %.1e\n", what, largest);
    EXPECT_GT(met, kRays / 2) << "hardly any smoke";
  }
}

}  // namespace
}  // namespace brume
