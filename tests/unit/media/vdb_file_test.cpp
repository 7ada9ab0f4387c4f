#include "renderer/media/vdb_file.h"

#include <gtest/gtest.h>
#include <openvdb/io/Stream.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <cmath>
#include <limits>

#include "tests/unit/media/vdb_test_tools.h"

namespace brume {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const auto& line : lines) text += line + "\n";
  return text;
}

const GridInfo& find(const std::vector<GridInfo>& infos, const std::string& name) {
  for (const GridInfo& info : infos)
    if (info.name == name) return info;
  ADD_FAILURE() << "no grid " << name;
  return infos.front();
}

std::vector<GridInfo> listed(const std::string& path, bool scan = false) {
  auto infos = list_grids(path, scan);
  EXPECT_TRUE(infos.ok()) << infos.error().message;
  return infos.ok() ? *infos : std::vector<GridInfo>(1);
}

LoadedGrid loaded(const std::string& path, const std::string& name = "density") {
  auto grid = load_grid(path, name);
  EXPECT_TRUE(grid.ok()) << grid.error().message;
  return grid.ok() ? *grid : LoadedGrid{};
}

std::string refusal(const std::string& path, const std::string& name = "density") {
  const auto grid = load_grid(path, name);
  EXPECT_FALSE(grid.ok());
  return grid.ok() ? "" : grid.error().message;
}

/// The error must be one short sentence with the file's name.
void expect_one_sentence(const Error& error, const std::string& path) {
  EXPECT_EQ(error.code, ErrorCode::BadInput);
  EXPECT_TRUE(contains(error.message, std::filesystem::path(path).filename().string())) << error.message;
  EXPECT_FALSE(contains(error.message, "\n")) << error.message;
  EXPECT_LT(error.message.size(), 700u) << error.message;
}

// ---- The description of grids ---------------------------------------------------------------------------------------

struct Row {
  std::string grid;
  std::uint64_t active;
  VoxelIndex low, high;
  Vec3d world_low, world_high;
  double min, max;
};

// The table in the README of the test data.
void expect_table(const std::string& path, double voxel_size, const std::vector<Row>& rows) {
  for (const bool scan : {false, true}) {
    const auto infos = listed(path, scan);
    ASSERT_EQ(infos.size(), 5u);
    for (const Row& row : rows) {
      SCOPED_TRACE(row.grid);
      const GridInfo& info = find(infos, row.grid);
      EXPECT_EQ(info.type, "float");
      EXPECT_EQ(info.grid_class, "fog volume");
      EXPECT_TRUE(info.affine);
      for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(info.voxel_size[axis], voxel_size, 1e-7);
      EXPECT_EQ(info.active_voxels, row.active);
      EXPECT_EQ(info.usable, row.active > 0);
      EXPECT_EQ(info.scanned, scan);
      if (row.active == 0) {
        EXPECT_TRUE(info.world_bounds.empty());
        continue;
      }
      EXPECT_EQ(info.index_min, row.low);
      EXPECT_EQ(info.index_max, row.high);
      for (int axis = 0; axis < 3; ++axis) {  // the table has four decimals
        EXPECT_NEAR(info.world_bounds.low[axis], row.world_low[axis], 6e-5);
        EXPECT_NEAR(info.world_bounds.high[axis], row.world_high[axis], 6e-5);
      }
      if (!scan) continue;
      EXPECT_NEAR(info.min, row.min, 6e-5);
      EXPECT_NEAR(info.max, row.max, 6e-4);
      EXPECT_EQ(info.non_finite, 0u);
      EXPECT_EQ(info.negative, row.min < 0 ? row.active : 0);
    }
    const GridInfo& velocity = find(infos, "velocity");
    EXPECT_EQ(velocity.type, "vec3s");
    EXPECT_EQ(velocity.grid_class, "staggered");
    EXPECT_FALSE(velocity.usable);
    EXPECT_TRUE(contains(velocity.why_not, "vec3s"));
  }
}

TEST(VdbInfo, SmokeFileMatchesItsTable) {
  const Vec3d low(0.2005, 0.0182, 0.0182), high(1.9505, 1.8047, 3.1536);
  expect_table(
      test::kSmoke, 0.0364583,
      {{"density", 70422, {6, 1, 1}, {53, 49, 86}, low, high, 0.0010, 0.811},
       {"temperature", 70302, {6, 1, 1}, {53, 49, 86}, low, high, 0.0010, 1.0},
       {"flame", 0, {}, {}, {}, {}, 0, 0},
       {"shadow", 290400, {0, 0, 0}, {54, 54, 95}, {-0.0182, -0.0182, -0.0182}, {1.9870, 1.9870, 3.4818}, -1, -1}});
}

TEST(VdbInfo, FireFileMatchesItsTable) {
  const Vec3d low(0.3719, 0.0219, 0.0219), high(1.9469, 1.8156, 3.0406);
  expect_table(
      test::kFire, 0.04375,
      {{"density", 38498, {9, 1, 1}, {44, 41, 69}, low, high, 0.0010, 0.0678},
       {"flame", 7141, {10, 6, 1}, {35, 30, 39}, {0.4156, 0.2406, 0.0219}, {1.5531, 1.3344, 1.7281}, 0.0010, 0.966},
       {"temperature", 38497, {9, 1, 1}, {44, 41, 69}, low, high, 0.0016, 2.949},
       {"shadow", 169280, {0, 0, 0}, {45, 45, 79}, {-0.0219, -0.0219, -0.0219}, {1.9906, 1.9906, 3.4781}, -1, -1}});
}

TEST(VdbInfo, TellsHalfAndCodec) {
  const GridInfo density = find(listed(test::kSmoke), "density");
  EXPECT_TRUE(density.is_half);
  EXPECT_EQ(density.codec, "active values");
  const auto grid = test::random_grid(1);
  grid->setGridClass(openvdb::GRID_UNKNOWN);  // OpenVDB does not zip fog volumes
  const GridInfo other = find(listed(test::write_vdb("codec.vdb", {grid})), "density");
  EXPECT_FALSE(other.is_half);
  EXPECT_EQ(other.codec, "zip + active values");
  EXPECT_EQ(other.grid_class, "unknown");
}

TEST(VdbInfo, IsTheSameWhetherFromMetadataTreeOrValues) {
  const auto grid = test::random_grid(2);
  const GridInfo told = find(listed(test::write_vdb("told.vdb", {grid})), "density");
  const std::string untold = test::write_vdb("untold.vdb", {grid}, test::kDefaultCompression, false);
  for (const bool scan : {false, true}) {
    const GridInfo found = find(listed(untold, scan), "density");
    EXPECT_EQ(found.active_voxels, grid->activeVoxelCount());
    EXPECT_EQ(found.active_voxels, told.active_voxels);
    EXPECT_EQ(found.index_min, told.index_min);
    EXPECT_EQ(found.index_max, told.index_max);
  }
}

TEST(VdbInfo, GuessesTheGridsToUse) {
  EXPECT_EQ(guess_density_grid(listed(test::kSmoke)), "density");
  EXPECT_EQ(guess_emission_grid(listed(test::kSmoke)), std::nullopt);  // its flame is empty
  EXPECT_EQ(guess_density_grid(listed(test::kFire)), "density");
  EXPECT_EQ(guess_emission_grid(listed(test::kFire)), "flame");

  const auto info = [](const char* name, const char* grid_class, bool usable = true) {
    GridInfo i;
    i.name = name, i.grid_class = grid_class, i.usable = usable;
    return i;
  };
  using Infos = std::vector<GridInfo>;
  EXPECT_EQ(guess_density_grid(Infos{}), std::nullopt);
  EXPECT_EQ(guess_density_grid(Infos{info("temperature", "fog volume"), info("Density", "unknown")}), "Density");
  EXPECT_EQ(guess_density_grid(Infos{info("cloud", "fog volume"), info("soot", "fog volume")}), "soot");
  EXPECT_EQ(
      guess_density_grid(Infos{info("shadow", "fog volume"), info("noise", "unknown"), info("cloud", "fog volume")}),
      "cloud");
  EXPECT_EQ(guess_density_grid(Infos{info("heat", "unknown"), info("noise", "unknown")}), "noise");
  EXPECT_EQ(guess_density_grid(Infos{info("density", "fog volume", false), info("smoke", "fog volume")}), "smoke");
  EXPECT_EQ(guess_density_grid(Infos{info("shadow", "fog volume"), info("temperature", "fog volume")}), std::nullopt);
  EXPECT_EQ(guess_emission_grid(Infos{info("density", "fog volume"), info("Flames", "fog volume")}), "Flames");
  EXPECT_EQ(guess_emission_grid(Infos{info("fire", "fog volume")}), "fire");
}

// ---- Values ---------------------------------------------------------------------------------------------------------

/// Compares with what OpenVDB itself reads from the file: every voxel of the active box and around.
template <class GridT> void expect_equals_openvdb(const std::string& path, const std::string& name = "density") {
  openvdb::io::File file(path);
  file.open(false);
  const auto reference = openvdb::gridPtrCast<GridT>(file.readGrid(name));
  ASSERT_TRUE(reference);
  const LoadedGrid found = loaded(path, name);
  ASSERT_TRUE(found.grid);
  const openvdb::CoordBBox active = reference->evalActiveVoxelBoundingBox();
  EXPECT_EQ(found.info.active_voxels, reference->activeVoxelCount());
  EXPECT_EQ(found.grid->active_voxels(), reference->activeVoxelCount());
  EXPECT_EQ(found.info.index_min, VoxelIndex(active.min().x(), active.min().y(), active.min().z()));
  EXPECT_EQ(found.info.index_max, VoxelIndex(active.max().x(), active.max().y(), active.max().z()));
  openvdb::CoordBBox wide = active;
  wide.expand(9);
  const auto accessor = reference->getConstAccessor();
  for (auto at = wide.begin(); at; ++at) {
    float expected = 0;
    if (active.isInside(*at) && (accessor.isValueOn(*at) || accessor.getValue(*at) != reference->background()))
      expected = static_cast<float>(accessor.getValue(*at));
    if (!std::isfinite(expected) || expected < 0) expected = 0;
    ASSERT_EQ(found.grid->voxel({(*at).x(), (*at).y(), (*at).z()}), expected) << *at;
  }
}

/// A grid with voxels, tiles and all kinds of inactive values round `background`.
template <class GridT> typename GridT::Ptr mixed_grid(double background, double scale, int kinds_of_inactive) {
  using Value = typename GridT::ValueType;
  const auto value = [](double v) {
    if constexpr (std::is_same_v<Value, bool>)
      return v > 0.5;
    else
      return static_cast<Value>(v);
  };
  std::mt19937 rng(17);
  std::uniform_int_distribution<int> place(-30, 30), near(-2, 2);
  std::uniform_real_distribution<double> u(0, scale);
  auto grid = GridT::create(value(background));
  auto accessor = grid->getAccessor();
  grid->tree().addTile(1, openvdb::Coord(-40, 8, 8), value(u(rng)), true);
  grid->tree().addTile(1, openvdb::Coord(8, 8, -40), value(u(rng)), false);
  for (int i = 0; i < 400; ++i) {
    const openvdb::Coord at(place(rng), place(rng), place(rng));
    accessor.setValue(at, value(u(rng)));
    for (int k = 0; k < kinds_of_inactive; ++k)
      accessor.setValueOff(at.offsetBy(near(rng), near(rng), near(rng)), value(scale * k));
  }
  grid->setName("density");
  return grid;
}

template <class GridT> void expect_all_ways_of_storing(double background, double scale) {
  const std::uint32_t ways[] = {
      openvdb::io::COMPRESS_NONE,  openvdb::io::COMPRESS_ACTIVE_MASK,
      openvdb::io::COMPRESS_ZIP,   openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK,
      openvdb::io::COMPRESS_BLOSC, openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK};
  for (const std::uint32_t way : ways)
    for (const bool half : {false, true})
      for (const int inactive : {0, 1, 2, 4}) {
        const auto grid = mixed_grid<GridT>(background, scale, inactive);
        grid->setSaveFloatAsHalf(half);
        SCOPED_TRACE(grid->type() + " way " + std::to_string(way) + " half " + std::to_string(half) + " inactive " +
                     std::to_string(inactive));
        const std::string path = test::write_vdb("ways.vdb", {grid}, way, inactive % 2 == 0);
        expect_equals_openvdb<GridT>(path);
      }
}

TEST(VdbValues, OfTheRealFilesEqualOpenVdb) {
  openvdb::initialize();
  for (const char* name : {"density", "temperature", "shadow"})
    expect_equals_openvdb<openvdb::FloatGrid>(test::kSmoke, name);
  for (const char* name : {"density", "temperature", "flame"})
    expect_equals_openvdb<openvdb::FloatGrid>(test::kFire, name);
}

TEST(VdbValues, FloatInAllWaysOfStoring) { expect_all_ways_of_storing<openvdb::FloatGrid>(0, 2); }
TEST(VdbValues, FloatRoundANonZeroBackground) { expect_all_ways_of_storing<openvdb::FloatGrid>(0.25, 2); }
TEST(VdbValues, DoubleInAllWaysOfStoring) { expect_all_ways_of_storing<openvdb::DoubleGrid>(0, 2); }
TEST(VdbValues, Int32InAllWaysOfStoring) { expect_all_ways_of_storing<openvdb::Int32Grid>(0, 40); }
TEST(VdbValues, Int64InAllWaysOfStoring) { expect_all_ways_of_storing<openvdb::Int64Grid>(3, 40); }
TEST(VdbValues, BoolInAllWaysOfStoring) { expect_all_ways_of_storing<openvdb::BoolGrid>(0, 1); }

TEST(VdbValues, TilesOfEveryLevelAreRead) {
  openvdb::initialize();
  for (const bool active : {true, false}) {
    auto grid = test::named(openvdb::FloatGrid::create(0.0f));
    grid->tree().addTile(1, openvdb::Coord(-8, 0, 0), 1, active);
    grid->tree().addTile(2, openvdb::Coord(-300, 0, 0), 2, active);
    grid->tree().addTile(2, openvdb::Coord(3000, 0, 0), 3, active);
    grid->tree().setValueOn(openvdb::Coord(-400, 0, 0), 4);
    grid->tree().setValueOn(openvdb::Coord(200, 40, 30), 4);
    const LoadedGrid found = loaded(test::write_vdb("tiles.vdb", {grid}));
    EXPECT_EQ(found.grid->active_voxels(), grid->activeVoxelCount());
    const auto accessor = grid->getConstAccessor();
    const int high = active ? 3072 : 200;
    for (int x = -500; x < 3100; ++x) {
      const float expected = x <= high ? accessor.getValue(openvdb::Coord(x, 5, 6)) : 0;
      ASSERT_EQ(found.grid->voxel({x, 5, 6}), expected) << x;
    }
  }
  auto huge = test::named(openvdb::FloatGrid::create(0.0f));
  huge->tree().addTile(3, openvdb::Coord(0), 1, true);  // 4096^3
  EXPECT_TRUE(contains(refusal(test::write_vdb("huge.vdb", {huge})), "crop")) << "more than the table may hold";
}

TEST(VdbValues, MaskCountsAsOne) {
  openvdb::initialize();
  auto mask = openvdb::MaskGrid::create();
  mask->setName("density");
  for (int i = 0; i < 200; ++i) mask->tree().setValueOn(openvdb::Coord(i * 7 % 40, i * 3 % 25, i % 18));
  mask->tree().addTile(1, openvdb::Coord(48, 0, 0), true, true);
  const LoadedGrid grid = loaded(test::write_vdb("mask.vdb", {mask}));
  EXPECT_EQ(grid.info.type, "mask");
  EXPECT_EQ(grid.grid->active_voxels(), mask->activeVoxelCount());
  for (auto at = mask->evalActiveVoxelBoundingBox().begin(); at; ++at)
    ASSERT_EQ(grid.grid->voxel({(*at).x(), (*at).y(), (*at).z()}), mask->tree().isValueOn(*at) ? 1.0f : 0.0f);
}

TEST(VdbValues, HalfKeepsWhatFitsAndReportsWhatDoesNot) {
  auto grid = test::named(openvdb::FloatGrid::create(0.0f));
  const float values[] = {1.0f, 0.333f, 6.0e-5f, 5.96e-8f, 1e-9f, 65504, 70000};
  for (int i = 0; i < 7; ++i) grid->tree().setValueOn(openvdb::Coord(i, 0, 0), values[i]);
  grid->setSaveFloatAsHalf(true);
  const LoadedGrid found = loaded(test::write_vdb("half.vdb", {grid}));
  EXPECT_TRUE(found.info.is_half);
  for (int i = 0; i < 6; ++i)  // 11 bits; below 6e-5 steps of 6e-8
    EXPECT_NEAR(found.grid->voxel({i, 0, 0}), values[i], std::max(values[i] / 2048, 3e-8f));
  EXPECT_EQ(found.grid->voxel({6, 0, 0}), 0);  // became infinite when it was saved
  EXPECT_EQ(found.info.non_finite, 1u);
  EXPECT_EQ(found.grid->non_finite_voxels(), 1u);
  EXPECT_TRUE(contains(joined(found.warnings), "1 voxel not finite")) << joined(found.warnings);
}

TEST(VdbValues, NanInfAndNegativeBecomeZeroWithAWarning) {
  auto grid = test::random_grid(3);
  const float bad[] = {kNan, kInf, -kInf, -0.5f, -1e-30f};
  for (int i = 0; i < 5; ++i) grid->tree().setValueOn(openvdb::Coord(100 + i, 0, 0), bad[i]);
  const std::string path = test::write_vdb("bad_values.vdb", {grid});
  const GridInfo info = find(listed(path, true), "density");
  EXPECT_EQ(info.non_finite, 3u);
  EXPECT_EQ(info.negative, 2u);
  EXPECT_EQ(info.min, -0.5f);
  const LoadedGrid found = loaded(path);
  EXPECT_EQ(found.grid->non_finite_voxels(), 3u);
  EXPECT_EQ(found.grid->negative_voxels(), 2u);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(found.grid->voxel({100 + i, 0, 0}), 0);
  EXPECT_TRUE(contains(joined(found.warnings), "3 voxels not finite")) << joined(found.warnings);
  EXPECT_TRUE(contains(joined(found.warnings), "2 voxels below 0"));
}

TEST(VdbValues, BackgroundIsTakenAsZeroWithAWarning) {
  for (const float background : {0.5f, -2.0f, kNan, kInf}) {
    auto grid = test::named(openvdb::FloatGrid::create(background));
    grid->tree().setValueOn(openvdb::Coord(0), 1);
    grid->tree().setValueOn(openvdb::Coord(40), 2);
    const LoadedGrid found = loaded(test::write_vdb("background.vdb", {grid}));
    EXPECT_TRUE(contains(joined(found.warnings), "background")) << background;
    EXPECT_EQ(found.grid->voxel({0, 0, 0}), 1);
    EXPECT_EQ(found.grid->voxel({1, 1, 1}), 0);
    EXPECT_EQ(found.grid->voxel({20, 20, 20}), 0);
    EXPECT_EQ(found.grid->non_finite_voxels() + found.grid->negative_voxels(), 0u);
  }
}

TEST(VdbValues, LevelSetBecomesFog) {
  openvdb::initialize();
  for (const bool says_so : {true, false}) {
    auto sphere = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(20.0f, openvdb::Vec3f(3, 0, 0), 1.0f);
    sphere->setName("ball");
    if (!says_so) sphere->setGridClass(openvdb::GRID_UNKNOWN);
    const LoadedGrid found = loaded(test::write_vdb("ball.vdb", {sphere}), "ball");
    ASSERT_TRUE(found.grid);
    EXPECT_TRUE(contains(joined(found.warnings), "level set")) << joined(found.warnings);
    EXPECT_EQ(found.grid->voxel({3, 0, 0}), 1);  // deep inside: a tile or a leaf
    EXPECT_EQ(found.grid->voxel({3, 12, 0}), 1);
    EXPECT_EQ(found.grid->voxel({24, 0, 0}), 0);  // outside
    EXPECT_EQ(found.grid->max_value(), 1);
    // The fog falls from 1 to 0 across the inner half of the band, three voxels.
    double volume = 0;
    for (int x = -22; x <= 28; ++x)
      for (int y = -22; y <= 22; ++y)
        for (int z = -22; z <= 22; ++z) volume += found.grid->voxel({x, y, z});
    EXPECT_NEAR(volume, 4.0 / 3 * 3.14159265 * 18.5 * 18.5 * 18.5, 0.03 * volume);
  }
}

// ---- Files ----------------------------------------------------------------------------------------------------------

TEST(VdbFile, FilesWrittenAsStreamsAreRead) {
  openvdb::initialize();
  const auto first = test::random_grid(4), second = test::random_grid(5);
  second->setName("flame");
  auto velocity = openvdb::Vec3SGrid::create();
  velocity->setName("velocity");
  velocity->tree().setValueOn(openvdb::Coord(3), openvdb::Vec3s(1, 2, 3));
  velocity->setSaveFloatAsHalf(true);
  const std::string path = test::scratch("stream.vdb");
  {
    std::ofstream out(path, std::ios::binary);
    openvdb::io::Stream(out).write(openvdb::GridCPtrVec{first, velocity, second});
  }
  ASSERT_EQ(listed(path).size(), 3u);
  for (const auto& [reference, name] : {std::pair{first, "density"}, std::pair{second, "flame"}}) {
    const LoadedGrid found = loaded(path, name);
    EXPECT_EQ(found.grid->active_voxels(), reference->activeVoxelCount());
    for (auto leaf = reference->tree().cbeginLeaf(); leaf; ++leaf)
      for (auto v = leaf->cbeginValueOn(); v; ++v)
        ASSERT_EQ(found.grid->voxel({v.getCoord().x(), v.getCoord().y(), v.getCoord().z()}), *v);
  }
}

TEST(VdbFile, GridsThatShareATreeKeepTheirOwnTransform) {
  const auto first = test::random_grid(6);
  auto second = openvdb::gridPtrCast<openvdb::FloatGrid>(first->copyGrid());  // shallow: the tree is shared
  second->setName("moved");
  second->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
  const std::string path = test::write_vdb("shared.vdb", {first, second});
  const auto infos = listed(path);
  EXPECT_EQ(find(infos, "moved").active_voxels, first->activeVoxelCount());
  EXPECT_NEAR(find(infos, "moved").voxel_size.x, 0.5, 1e-12);
  EXPECT_EQ(loaded(path, "moved").grid->active_voxels(), first->activeVoxelCount());
}

TEST(VdbFile, RepeatedNamesAreNumbered) {
  const auto first = test::random_grid(7), second = test::random_grid(8);
  const std::string path = test::write_vdb("twice.vdb", {first, second});
  EXPECT_EQ(loaded(path, "density[0]").grid->active_voxels(), first->activeVoxelCount());
  EXPECT_EQ(loaded(path, "density[1]").grid->active_voxels(), second->activeVoxelCount());
  EXPECT_EQ(loaded(path, "density").grid->active_voxels(), first->activeVoxelCount());
  EXPECT_EQ(guess_density_grid(listed(path)), "density[0]");
}

TEST(VdbFile, AnyAffineTransformIsRead) {
  using openvdb::math::Transform;
  std::vector<Transform::Ptr> transforms;
  transforms.push_back(Transform::createLinearTransform(0.1));
  transforms.push_back(Transform::createLinearTransform(openvdb::Mat4d::identity()));
  transforms.emplace_back(new Transform(openvdb::math::MapBase::Ptr(new openvdb::math::ScaleMap({0.1, 0.2, -0.3}))));
  transforms.emplace_back(new Transform(openvdb::math::MapBase::Ptr(new openvdb::math::TranslationMap({4, 5, 6}))));
  transforms.emplace_back(
      new Transform(openvdb::math::MapBase::Ptr(new openvdb::math::ScaleTranslateMap({0.1, 0.2, 0.3}, {1, 2, 3}))));
  transforms.emplace_back(
      new Transform(openvdb::math::MapBase::Ptr(new openvdb::math::UniformScaleTranslateMap(0.1, {1, 2, 3}))));
  transforms.emplace_back(new Transform(openvdb::math::MapBase::Ptr(new openvdb::math::UnitaryMap({1, 2, 3}, 0.7))));
  auto general = Transform::createLinearTransform(0.2);
  general->postRotate(0.4, openvdb::math::X_AXIS);
  general->postRotate(-1.1, openvdb::math::Z_AXIS);
  general->preShear(0.3, openvdb::math::X_AXIS, openvdb::math::Y_AXIS);
  general->postScale(openvdb::Vec3d(1, -2, 0.5));
  general->postTranslate({1e6, -3, 7});
  transforms.push_back(general);
  for (const auto& transform : transforms) {
    SCOPED_TRACE(transform->baseMap()->str());
    auto grid = test::random_grid(9);
    grid->setTransform(transform);
    const LoadedGrid found = loaded(test::write_vdb("transform.vdb", {grid}));
    for (const openvdb::Vec3d p : {openvdb::Vec3d(0, 0, 0), openvdb::Vec3d(10, -20, 30), openvdb::Vec3d(-7.5, 1, 2)}) {
      const openvdb::Vec3d expected = transform->indexToWorld(p);
      const Vec3d world = found.index_to_world.point({p.x(), p.y(), p.z()});
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(world[axis], expected[axis], 1e-9 * (1 + std::abs(expected[axis])));
    }
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(found.info.voxel_size[axis], transform->voxelSize()[axis], 1e-9);
  }
}

TEST(VdbFile, FrustumIsRefusedClearly) {
  auto frustum = test::random_grid(10);
  frustum->setName("camera");
  frustum->setTransform(
      openvdb::math::Transform::createFrustumTransform(openvdb::BBoxd({0, 0, 0}, {100, 100, 50}), 0.5, 10, 0.1));
  const std::string path = test::write_vdb("frustum.vdb", {frustum, test::random_grid(11)});
  EXPECT_FALSE(find(listed(path), "camera").affine);
  const std::string why = refusal(path, "camera");
  EXPECT_TRUE(contains(why, "frustum") && contains(why, "usable grids: density")) << why;
}

TEST(VdbFile, SingularTransformIsRefused) {
  const std::string path = test::write_vdb("singular.vdb", {test::random_grid(12)});
  std::string bytes = test::bytes_of(path);
  const auto at = bytes.find("UniformScaleMap");
  ASSERT_NE(at, std::string::npos);
  std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at) + 15, 24, '\0');
  test::write_bytes(path, bytes);
  EXPECT_TRUE(contains(refusal(path), "inverted")) << refusal(path);
}

TEST(VdbFile, TypesThatAreNoDensityAreRefusedWithTheUsableOnesListed) {
  openvdb::initialize();
  auto vector = openvdb::Vec3SGrid::create();
  vector->setName("velocity");
  vector->tree().setValueOn(openvdb::Coord(1), openvdb::Vec3s(1));
  auto integers = openvdb::Vec3IGrid::create();
  integers->setName("label");
  auto custom = openvdb::Grid<openvdb::tree::Tree4<float, 5, 4, 4>::Type>::create();
  custom->setName("big_leaves");
  custom->tree().setValueOn(openvdb::Coord(1), 1);
  std::decay_t<decltype(*custom)>::registerGrid();
  const std::string path = test::write_vdb("types.vdb", {vector, integers, custom, test::random_grid(13)});
  using Case = std::pair<const char*, const char*>;
  for (const auto& [name, word] :
       {Case("velocity", "vec3s"), Case("label", "vec3i"), Case("big_leaves", "unusual tree")}) {
    const std::string why = refusal(path, name);
    EXPECT_TRUE(contains(why, word) && contains(why, "usable grids: density")) << why;
    EXPECT_FALSE(find(listed(path, true), name).usable);
  }

  std::string bytes = test::bytes_of(test::write_vdb("points.vdb", {test::random_grid(13)}));
  bytes.replace(bytes.find("Tree_float_5_4_3"), 16, "Tree_ptdat_5_4_3");
  test::write_bytes(test::scratch("points.vdb"), bytes);
  EXPECT_TRUE(contains(refusal(test::scratch("points.vdb")), "points"));
}

TEST(VdbFile, UnknownGridNameListsThoseThereAre) {
  const std::string why = refusal(test::kFire, "dnesity");
  for (const char* word : {"\"dnesity\"", "fire_80_f036.vdb", "density", "flame", "shadow", "temperature", "velocity"})
    EXPECT_TRUE(contains(why, word)) << why;
}

TEST(VdbFile, EmptyGridsAreRefused) {
  EXPECT_TRUE(contains(refusal(test::kSmoke, "flame"), "no active voxel"));
  const std::string nothing = test::write_vdb("nothing.vdb", openvdb::GridCPtrVec{});
  EXPECT_TRUE(contains(refusal(nothing), "no grids")) << refusal(nothing);
  EXPECT_FALSE(list_grids(nothing).ok());
}

TEST(VdbFile, AllZeroGridLoadsWithAWarning) {
  EXPECT_TRUE(contains(joined(loaded(test::kSmoke, "shadow").warnings), "every voxel is 0"));
}

TEST(VdbFile, NonAsciiPathIsRead) {
  const std::string path = test::scratch("Wölkchen 雲.vdb");
  std::filesystem::copy_file(test::kSmoke, path, std::filesystem::copy_options::overwrite_existing);
  EXPECT_EQ(listed(path).size(), 5u);
  EXPECT_EQ(loaded(path).grid->active_voxels(), 70422u);
}

TEST(VdbFile, ProgressGrowsToOneAndCancellingStops) {
  std::vector<float> reports;
  std::stop_source stop;
  LoadOptions options{[&](float p) { reports.push_back(p); }, stop.get_token()};
  ASSERT_TRUE(load_grid(test::kSmoke, "density", options).ok());
  EXPECT_TRUE(std::is_sorted(reports.begin(), reports.end()));
  ASSERT_FALSE(reports.empty());
  EXPECT_NEAR(reports.back(), 1, 1e-6);

  for (const float when : {0.0f, 0.4f, 0.7f}) {
    std::stop_source later;
    options = {[&](float p) {
                 if (p >= when) later.request_stop();
               },
               later.get_token()};
    const auto cancelled = load_grid(test::kSmoke, "density", options);
    ASSERT_FALSE(cancelled.ok());
    EXPECT_EQ(cancelled.error().code, ErrorCode::Cancelled);
  }
}

TEST(VdbFile, PathsThatAreNoFilesAreRefused) {
  const std::string zero = test::scratch("zero.vdb"), text = test::scratch("text.vdb"),
                    secret = test::scratch("secret.vdb");
  test::write_bytes(zero, "");
  test::write_bytes(text, "This is not a grid.\n");
  test::write_bytes(secret, test::bytes_of(test::kSmoke));
  std::filesystem::permissions(secret, std::filesystem::perms::none);
  std::vector<std::string> paths = {zero, text, test::scratch("missing.vdb"), test::scratch(""), "/dev/null", ""};
  if (!std::ifstream(secret)) paths.push_back(secret);  // not for root, who may read everything
  for (const std::string& path : paths) {
    const auto infos = list_grids(path);
    ASSERT_FALSE(infos.ok()) << path;
    expect_one_sentence(infos.error(), path);
    const auto grid = load_grid(path, "density");
    ASSERT_FALSE(grid.ok());
    EXPECT_EQ(grid.error().message, infos.error().message);
  }
}

TEST(VdbFile, OtherFormatVersionsAreNamed) {
  const std::string path = test::scratch("version.vdb");
  std::string bytes = test::bytes_of(test::kSmoke);
  for (const char version : {static_cast<char>(200), static_cast<char>(225)}) {
    bytes[8] = version;
    test::write_bytes(path, bytes);
    EXPECT_TRUE(contains(refusal(path), "version")) << refusal(path);
  }
}

// ---- Damaged files --------------------------------------------------------------------------------------------------

/// Whatever the bytes: an answer, and if it is an error, one sentence.
void expect_an_answer(const std::string& path, const std::string& bytes, bool must_fail = false) {
  test::write_bytes(path, bytes);
  const auto infos = list_grids(path, true);
  if (!infos.ok()) expect_one_sentence(infos.error(), path);
  const auto grid = load_grid(path, "density");
  if (!grid.ok()) expect_one_sentence(grid.error(), path);
  EXPECT_FALSE(must_fail && (infos.ok() || grid.ok()));
}

// O12 of the catalogue.
TEST(VdbDamage, CutOffAnywhereIsAnError) {
  const std::string whole = test::bytes_of(test::kSmoke), path = test::scratch("cut.vdb");
  for (std::size_t n = 0; n < whole.size(); n += 997) expect_an_answer(path, whole.substr(0, n), true);
  expect_an_answer(path, whole.substr(0, whole.size() - 1), true);
  EXPECT_TRUE(contains(refusal(path), "cut off")) << refusal(path);
}

/// Small files with every way of storing values.
std::vector<std::string> small_files() {
  std::vector<std::string> files;
  const std::uint32_t ways[] = {openvdb::io::COMPRESS_NONE,
                                openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK,
                                openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK};
  for (const std::uint32_t way : ways)
    for (const bool half : {false, true}) {
      auto grid = openvdb::FloatGrid::create(0.0f);
      grid->setName("density");  // without a class, so that it may be zipped
      for (int i = 0; i < 300; ++i)
        grid->tree().setValue(openvdb::Coord(i % 7, i / 7 % 9, i / 63), static_cast<float>(i % 13));
      for (int i = 0; i < 5; ++i) grid->tree().setValueOff(openvdb::Coord(i, 0, 9), static_cast<float>(i));
      grid->tree().addTile(1, openvdb::Coord(16, 0, 0), 2, true);
      grid->setSaveFloatAsHalf(half);
      files.push_back(test::bytes_of(test::write_vdb("small.vdb", {grid}, way, half)));
    }
  return files;
}

TEST(VdbDamage, AnyFlippedBitIsSurvived) {
  const std::string path = test::scratch("flipped.vdb");
  std::mt19937 rng(1);
  for (const std::string& whole : small_files()) {
    // A bit in each byte of the description, then some of the rest (uncompressed trees are long and dull).
    const std::size_t dense = std::min<std::size_t>(whole.size(), 600) * 8;
    for (std::size_t bit = rng() % 8; bit < whole.size() * 8;
         bit += bit < dense ? 1 + rng() % 15 : 1 + rng() % (whole.size() / 8)) {
      std::string bytes = whole;
      bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ 1 << bit % 8);
      expect_an_answer(path, bytes);
    }
  }
}

TEST(VdbDamage, FlippedBitsInTheRealFileAreSurvived) {
  const std::string whole = test::bytes_of(test::kFire), path = test::scratch("flipped_fire.vdb");
  std::mt19937 rng(2);
  for (int i = 0; i < 150; ++i) {
    std::string bytes = whole;
    const std::size_t bit = rng() % (whole.size() * 8);
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ 1 << bit % 8);
    expect_an_answer(path, bytes);
  }
}

TEST(VdbDamage, RandomBytesAreSurvived) {
  const std::string path = test::scratch("random.vdb");
  std::mt19937 rng(3);
  for (const std::string& whole : small_files())
    for (int i = 0; i < 30; ++i) {
      std::string bytes = whole;
      for (unsigned k = 0; k <= rng() % 8; ++k) {
        const std::size_t at = rng() % bytes.size(), n = std::min<std::size_t>(1 + rng() % 8, bytes.size() - at);
        for (std::size_t j = 0; j < n; ++j) bytes[at + j] = static_cast<char>(rng() % 3 == 0 ? 0xFF : rng());
      }
      expect_an_answer(path, bytes);
    }
}

TEST(VdbDamage, HugeCountsAreRefusedAtOnce) {
  const std::string path = test::scratch("counts.vdb");
  for (const std::string& whole : small_files())
    for (std::size_t at = 8; at < 700; at += 1 + at % 3) {
      std::string bytes = whole;
      bytes.replace(at, 4, at % 2 == 0 ? "\xFF\xFF\xFF\x7F" : "\xFF\xFF\xFF\xFF");
      expect_an_answer(path, bytes);
    }
}

}  // namespace
}  // namespace brume
