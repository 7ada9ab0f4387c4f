// O12 of the catalogue: grids with bad data (H1 to H7), as far as the picture. Reading them is tested in
// tests/unit/media/vdb_file_test.cpp; here nothing may crash, what is refused or mended is said, and no sample of any
// integrator may be NaN or infinite.
#include <gtest/gtest.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "tests/support/effort.h"
#include "tests/support/scenes.h"
#include "tests/unit/media/vdb_test_tools.h"

namespace brume {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

/// A fog of 6 x 6 x 6 voxels of density about 1, from world 0 to 1.2.
openvdb::FloatGrid::Ptr fog(const std::string& name = "density") {
  openvdb::initialize();
  auto grid = openvdb::FloatGrid::create(0.0f);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(0.2));
  for (int i = 0; i < 216; ++i)
    grid->tree().setValue(openvdb::Coord(i % 6, i / 6 % 6, i / 36), 1 + 0.1f * static_cast<float>(i % 5));
  return test::named(grid, name);
}

openvdb::FloatGrid::Ptr fog_with(std::initializer_list<float> values, const std::string& name = "density") {
  auto grid = fog(name);
  int i = 0;
  for (const float value : values) grid->tree().setValue(openvdb::Coord(1 + i++, 3, 3), value);
  return grid;
}

Node scene_of(const std::string& file, const std::string& integrator) {
  Node scene = empty_scene();
  set(scene, "camera.position", "0.6,-4,0.7");
  set(scene, "camera.look_at", "0.5,0.5,0.5");
  set(scene, "camera.vfov_deg", "25");
  set(scene, "render.integrator", integrator);
  set(scene, "render.bounces", "2");
  if (scene.child("render").table().find("shadow_map_resolution")) set(scene, "render.shadow_map_resolution", "8");
  Node& v = add_volume(scene, "vdb");
  set(v, "file", file);
  set(v, "density_scale", "2");
  set(v, "phase.type", "henyey_greenstein");
  set(v, "phase.g", "0.5");
  set(add_light(scene, "point"), "position", "0.5,0.5,0.5");  // inside
  add_light(scene, "directional");
  add_light(scene, "environment");
  return scene;
}

Result<std::shared_ptr<const Scene>> try_commit(const Node& description) {
  SceneCache cache;
  return commit(description, cache, {});
}

/// Every pixel is finite and not negative, and no sample had to be dropped.
void expect_clean_picture(const Scene& scene, const std::string& what, int size = 8, int samples = 4) {
  WorkerPool pool(2);
  Film film(size, size);
  const RenderStatistics statistics = render_batch(scene, samples, film, pool);
  EXPECT_EQ(statistics.rays.non_finite, 0u) << what << ", " << scene.render.integrator;
  for (const Color& c : film.mean_image().pixels)
    ASSERT_TRUE(is_finite(c) && std::min({c.r, c.g, c.b}) >= 0)
        << what << ", " << scene.render.integrator << ": " << c.r << ' ' << c.g << ' ' << c.b;
}

void expect_clean_pictures(const Node& description, const std::string& what, int size = 8) {
  for (const IntegratorType& type : integrator_types()) {
    Node scene = description;
    set(scene, "render.integrator", type.table.key);
    const auto made = try_commit(scene);
    ASSERT_TRUE(made.ok()) << what << ": " << made.error().to_string();
    expect_clean_picture(**made, what, size);
  }
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// The grid is rendered by all integrators, and the scene's warnings say `said`.
void expect_mended(const std::string& name, const openvdb::GridBase::Ptr& grid, const std::string& said) {
  const std::string file = test::write_vdb("oracle_" + name + ".vdb", {grid});
  const auto scene = try_commit(scene_of(file, "decoupled"));
  ASSERT_TRUE(scene.ok()) << name << ": " << scene.error().to_string();
  EXPECT_NE(joined((*scene)->warnings).find(said), std::string::npos) << name << ": " << joined((*scene)->warnings);
  expect_clean_pictures(scene_of(file, "decoupled"), name);
}

TEST(OracleData, O12VoxelsThatAreNoDensityAreMendedWithAMessage) {
  expect_mended("nan", fog_with({kNan}), "not finite");
  expect_mended("infinite", fog_with({kInf, -kInf}), "not finite");
  expect_mended("negative", fog_with({-1, -1e30f}), "below 0");
  expect_mended("all_kinds", fog_with({kNan, -2, kInf, 0, -0.0f}), "not finite");
  auto half = fog_with({1e6f, -1e6f});
  half->setSaveFloatAsHalf(true);
  expect_mended("half_infinite", half, "not finite");
  auto background = openvdb::FloatGrid::create(0.7f);
  background->setTransform(openvdb::math::Transform::createLinearTransform(0.2));
  background->tree().setValue(openvdb::Coord(3, 3, 3), 2.0f);
  expect_mended("background", test::named(background), "background");
  auto nothing = fog();
  for (auto voxel = nothing->beginValueOn(); voxel; ++voxel) voxel.setValue(kNan);
  expect_mended("all_nan", nothing, "every voxel is 0");
}

TEST(OracleData, O12ALevelSetIsRenderedAsFogWithAMessage) {
  openvdb::initialize();
  auto sphere = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(0.5f, openvdb::Vec3f(0.6f), 0.1f);
  sphere->setName("density");
  expect_mended("level_set", sphere, "level set");
}

TEST(OracleData, O12GridsWithoutADensityAreRefusedWithAMessage) {
  openvdb::initialize();
  auto vectors = openvdb::Vec3SGrid::create();
  vectors->tree().setValue(openvdb::Coord(0), openvdb::Vec3s(1));
  vectors->setName("density");
  auto empty = test::named(openvdb::FloatGrid::create(0.0f));
  const std::pair<const char*, openvdb::GridBase::Ptr> refused[] = {{"vectors", vectors}, {"empty", empty}};
  for (const auto& [name, grid] : refused) {
    const std::string file = test::write_vdb(std::string("oracle_") + name + ".vdb", {grid});
    const auto scene = try_commit(scene_of(file, "decoupled"));
    ASSERT_FALSE(scene.ok()) << name;
    EXPECT_NE(scene.error().to_string().find(std::string("oracle_") + name), std::string::npos)
        << scene.error().to_string();
    EXPECT_EQ(scene.error().source.key.substr(0, 9), "volumes.0") << scene.error().to_string();
  }
}

// Not bad data, but hard on float arithmetic: densities so large that they, their squares or their optical depths do
// not fit, so small that they are denormal, and jumps between both.
Node extreme(const std::string& name, std::initializer_list<float> values) {
  return scene_of(test::write_vdb("oracle_" + name + ".vdb", {fog_with(values)}), "decoupled");
}

// The largest density sets the majorant, and so how often a free flight ends on nothing: the flights of a ray are
// bounded, as the steps of a march are.
TEST(OracleData, O12ExtremeDensitiesGiveFinitePictures) {
  const Node denormal = extreme("denormal", {1e-40f, 1e-45f, std::numeric_limits<float>::min()});
  expect_clean_pictures(denormal, "denormal");
  expect_clean_pictures(extreme("hot", {1e3f}), "hot");
  expect_clean_pictures(extreme("huge", {1e6f, 1e12f, 1e18f}), "huge", 3);
  expect_clean_pictures(extreme("beyond_squares", {1e25f}), "beyond squares", 3);
  expect_clean_pictures(extreme("largest", {1e30f}), "largest", 3);
}

TEST(OracleData, O12EmissionIsMendedLikeDensity) {
  const std::string file = test::write_vdb("oracle_emission.vdb", {fog(), fog_with({kNan, kInf, -3}, "flame")});
  Node scene = scene_of(file, "decoupled");
  set(scene, "volumes.0.emission_grid", "flame");
  set(scene, "volumes.0.emission_scale", "3");
  const auto made = try_commit(scene);
  ASSERT_TRUE(made.ok()) << made.error().to_string();
  EXPECT_NE(joined((*made)->warnings).find("not finite"), std::string::npos);
  expect_clean_pictures(scene, "emission");
  set(scene, "volumes.0.grid", "");  // fire without smoke
  expect_clean_pictures(scene, "emission only");
}

/// A file that is refused says so with its name; one that is not makes a clean picture.
void expect_answer(const std::string& file, const std::string& what, int& refused) {
  for (const char* integrator : {"decoupled", "stochastic_march"}) {
    const auto scene = try_commit(scene_of(file, integrator));
    if (scene.ok()) {
      expect_clean_picture(**scene, what, 4, 1);
    } else {
      ++refused;
      EXPECT_NE(scene.error().to_string().find("oracle_damaged"), std::string::npos) << what;
    }
  }
}

TEST(OracleData, O12TruncatedFilesAreRefused) {
  const std::string bytes = test::bytes_of(test::write_vdb("oracle_whole.vdb", {fog()}));
  const std::string file = test::scratch("oracle_damaged.vdb");
  int refused = 0, tried = 0;
  for (std::size_t size = 0; size < bytes.size(); size += 64) {
    test::write_bytes(file, bytes.substr(0, size));
    expect_answer(file, std::to_string(size) + " bytes", refused);
    tried += 2;
  }
  EXPECT_EQ(refused, tried);
}

TEST(OracleData, O12FilesWithFlippedBitsAreRefusedOrMakeCleanPictures) {
  const std::string bytes = test::bytes_of(test::write_vdb("oracle_whole.vdb", {fog()}, openvdb::io::COMPRESS_NONE));
  const std::string file = test::scratch("oracle_damaged.vdb");
  int refused = 0, tried = 0;
  // A third of the flips in the head of the file (names, transform, tree), a third in its end (the voxels).
  const std::size_t flips = (full_effort() ? 3000 : 240) / kFewer, size = 8 * bytes.size(), part = 8 * 2048;
  for (std::size_t k = 0; k < flips; ++k) {
    const std::size_t spread = k * 2654435761u;
    const std::size_t bit = k % 3 == 0 ? spread % part : k % 3 == 1 ? size - 1 - spread % part : spread % size;
    std::string damaged = bytes;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
    test::write_bytes(file, damaged);
    expect_answer(file, "bit " + std::to_string(bit), refused);
    tried += 2;
  }
  std::printf("%d of %d damaged scenes were refused, the others rendered\n", refused, tried);
  EXPECT_GT(refused, 0);
  EXPECT_LT(refused, tried);
}

}  // namespace
}  // namespace brume
