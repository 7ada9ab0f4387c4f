#include "renderer/media/nanovdb_file.h"

#include <gtest/gtest.h>
#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <cmath>

#include "tests/unit/media/vdb_test_tools.h"

namespace brume {
namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string write_nvdb(const std::string& name, const std::vector<nanovdb::GridHandle<nanovdb::HostBuffer>*>& grids) {
  const std::string path = test::scratch(name);
  std::ofstream out(path, std::ios::binary);
  for (const auto* grid : grids) nanovdb::io::writeGrid(out, *grid);  // one segment each
  return path;
}

template <class Build> nanovdb::GridHandle<nanovdb::HostBuffer> packed(openvdb::FloatGrid& grid) {
  nanovdb::OpenToNanoVDB<float, Build> convert;
  convert.enableDithering(false);
  return convert(grid);
}

/// The file must hold what OpenVDB holds, within `tolerance`.
void expect_equals(const openvdb::FloatGrid& reference, const std::string& path, const std::string& type,
                   float tolerance) {
  const auto infos = list_grids(path, true);
  ASSERT_TRUE(infos.ok()) << infos.error().message;
  ASSERT_EQ(infos->size(), 1u);
  const GridInfo& info = infos->front();
  const openvdb::CoordBBox active = reference.evalActiveVoxelBoundingBox();
  EXPECT_EQ(info.name, "density");
  EXPECT_EQ(info.type, type);
  EXPECT_EQ(info.grid_class, "fog volume");
  EXPECT_TRUE(info.usable);
  EXPECT_EQ(info.active_voxels, reference.activeVoxelCount());
  EXPECT_EQ(info.index_min, VoxelIndex(active.min().x(), active.min().y(), active.min().z()));
  EXPECT_EQ(info.index_max, VoxelIndex(active.max().x(), active.max().y(), active.max().z()));

  const auto found = load_grid(path, "density");
  ASSERT_TRUE(found.ok()) << found.error().message;
  EXPECT_EQ(found->grid->active_voxels(), reference.activeVoxelCount());
  const auto accessor = reference.getConstAccessor();
  for (auto at = active.begin(); at; ++at)
    ASSERT_NEAR(found->grid->voxel({(*at).x(), (*at).y(), (*at).z()}), accessor.getValue(*at), tolerance) << *at;
  for (const openvdb::Vec3d p : {openvdb::Vec3d(0, 0, 0), openvdb::Vec3d(10, -20, 30), openvdb::Vec3d(-7.5, 1, 2)}) {
    const openvdb::Vec3d expected = reference.indexToWorld(p);
    const Vec3d world = found->index_to_world.point({p.x(), p.y(), p.z()});
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(world[axis], expected[axis], 1e-9 * (1 + std::abs(expected[axis])));
  }
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(info.voxel_size[axis], reference.voxelSize()[axis], 1e-9);
}

TEST(NanoVdbFile, FloatEqualsOpenVdb) {
  for (const auto& grid : {test::read_with_openvdb(test::kSmoke, "density"), test::random_grid(21)}) {
    auto nano = nanovdb::openToNanoVDB(*grid);
    expect_equals(*grid, write_nvdb("float.nvdb", {&nano}), "float", 0);
  }
}

TEST(NanoVdbFile, PackedKindsAreAsExactAsTheyCanBe) {
  const auto grid = test::read_with_openvdb(test::kSmoke, "density");
  // Each leaf is stored with 2^bits steps between its smallest and largest value, which differ by at most 0.811.
  auto fp4 = packed<nanovdb::Fp4>(*grid), fp8 = packed<nanovdb::Fp8>(*grid), fp16 = packed<nanovdb::Fp16>(*grid),
       fpn = packed<nanovdb::FpN>(*grid);
  expect_equals(*grid, write_nvdb("fp4.nvdb", {&fp4}), "Fp4", 0.811f / 15);
  expect_equals(*grid, write_nvdb("fp8.nvdb", {&fp8}), "Fp8", 0.811f / 255);
  expect_equals(*grid, write_nvdb("fp16.nvdb", {&fp16}), "Fp16", 0.811f / 65535);
  expect_equals(*grid, write_nvdb("fpn.nvdb", {&fpn}), "FpN", 0.02f);
}

TEST(NanoVdbFile, DoubleAndIntegersAreRead) {
  openvdb::initialize();
  auto doubles = openvdb::DoubleGrid::create(0.0);
  auto integers = openvdb::Int32Grid::create(0);
  doubles->setName("d"), integers->setName("i");
  for (int i = 0; i < 100; ++i) {
    doubles->tree().setValueOn(openvdb::Coord(i % 10, i / 10, 3), i * 0.5);
    integers->tree().setValueOn(openvdb::Coord(i % 10, i / 10, 3), i);
  }
  auto d = nanovdb::openToNanoVDB(*doubles);
  auto i = nanovdb::openToNanoVDB(*integers);
  const std::string path = write_nvdb("numbers.nvdb", {&d, &i});
  const auto found_d = load_grid(path, "d"), found_i = load_grid(path, "i");
  ASSERT_TRUE(found_d.ok()) << found_d.error().message;
  ASSERT_TRUE(found_i.ok()) << found_i.error().message;
  EXPECT_EQ(found_d->grid->voxel({7, 2, 3}), 13.5f);
  EXPECT_EQ(found_i->grid->voxel({7, 2, 3}), 27.0f);
}

TEST(NanoVdbFile, AnyTransformIsRead) {
  auto grid = test::random_grid(22);
  auto transform = openvdb::math::Transform::createLinearTransform(0.2);
  transform->postRotate(0.4, openvdb::math::X_AXIS);
  transform->postScale(openvdb::Vec3d(1, -2, 0.5));
  transform->postTranslate({100, -3, 7});
  grid->setTransform(transform);
  auto nano = nanovdb::openToNanoVDB(*grid);
  expect_equals(*grid, write_nvdb("turned.nvdb", {&nano}), "float", 0);
}

TEST(NanoVdbFile, BackgroundIsTakenAsZeroWithAWarning) {
  auto grid = test::named(openvdb::FloatGrid::create(0.5f));
  grid->tree().setValueOn(openvdb::Coord(0), 1);
  grid->tree().setValueOn(openvdb::Coord(40), 2);
  auto nano = nanovdb::openToNanoVDB(*grid);
  const auto found = load_grid(write_nvdb("background.nvdb", {&nano}), "density");
  ASSERT_TRUE(found.ok());
  ASSERT_EQ(found->warnings.size(), 1u);
  EXPECT_TRUE(contains(found->warnings[0], "background"));
  EXPECT_EQ(found->grid->voxel({1, 1, 1}), 0);
  EXPECT_EQ(found->grid->voxel({40, 40, 40}), 2);
}

TEST(NanoVdbFile, WhatIsNoDensityIsRefusedWithTheUsableOnesListed) {
  openvdb::initialize();
  auto vector = openvdb::Vec3SGrid::create();
  vector->setName("velocity");
  vector->tree().setValueOn(openvdb::Coord(1), openvdb::Vec3s(1));
  auto ball = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(5, openvdb::Vec3f(0), 1);
  ball->setName("ball");
  auto v = nanovdb::openToNanoVDB(*vector);
  auto b = nanovdb::openToNanoVDB(*ball);
  auto d = nanovdb::openToNanoVDB(*test::random_grid(23));
  const std::string path = write_nvdb("types.nvdb", {&v, &b, &d});
  using Case = std::pair<const char*, const char*>;
  for (const auto& [name, word] :
       {Case("velocity", "vec3s"), Case("ball", "level set"), Case("nothing", "velocity, ball, density")}) {
    const auto refused = load_grid(path, name);
    ASSERT_FALSE(refused.ok());
    EXPECT_TRUE(contains(refused.error().message, word) && contains(refused.error().message, "density"))
        << refused.error().message;
  }
  EXPECT_EQ(guess_density_grid(*list_grids(path)), "density");
}

/// Whatever the bytes: an answer, and if it is an error, one sentence with the file's name.
void expect_an_answer(const std::string& path, const std::string& bytes, bool must_fail = false) {
  test::write_bytes(path, bytes);
  const auto infos = list_grids(path, true);
  const auto grid = load_grid(path, "density");
  for (const Error* error : {infos.ok() ? nullptr : &infos.error(), grid.ok() ? nullptr : &grid.error()}) {
    EXPECT_FALSE(must_fail && !error);
    if (!error) continue;
    EXPECT_TRUE(contains(error->message, std::filesystem::path(path).filename().string())) << error->message;
    EXPECT_FALSE(contains(error->message, "\n")) << error->message;
  }
}

TEST(NanoVdbDamage, CutOffAnywhereIsAnError) {
  auto nano = nanovdb::openToNanoVDB(*test::read_with_openvdb(test::kSmoke, "density"));
  const std::string whole = test::bytes_of(write_nvdb("whole.nvdb", {&nano})), path = test::scratch("cut.nvdb");
  for (std::size_t n = 0; n < whole.size(); n += 9973) expect_an_answer(path, whole.substr(0, n), true);
}

TEST(NanoVdbDamage, FlippedBitsAreSurvived) {
  auto grid = test::named(openvdb::FloatGrid::create(0.0f));
  for (int i = 0; i < 300; ++i) grid->tree().setValueOn(openvdb::Coord(i % 17, i / 17, i % 5), static_cast<float>(i));
  auto floats = nanovdb::openToNanoVDB(*grid);
  auto fpn = packed<nanovdb::FpN>(*grid);
  const std::string path = test::scratch("flipped.nvdb");
  std::mt19937 rng(4);
  for (auto* nano : {&floats, &fpn}) {
    const std::string whole = test::bytes_of(write_nvdb("small.nvdb", {nano}));
    // Descriptions, grid header, tree and root lie in the first two kilobytes; then come long tables.
    for (std::size_t bit = rng() % 8; bit < whole.size() * 8;
         bit += bit < 2048 * 8 ? 1 + rng() % 127 : 1 + rng() % (whole.size() / 4)) {
      std::string bytes = whole;
      bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ 1 << bit % 8);
      expect_an_answer(path, bytes);
    }
  }
}

}  // namespace
}  // namespace brume
