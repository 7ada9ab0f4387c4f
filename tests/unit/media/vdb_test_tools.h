// Grids made with OpenVDB, for the tests of the readers and the look-up.
#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "renderer/media/brick_grid.h"

namespace brume::test {

inline const std::string kSmoke = std::string(BRUME_SOURCE_DIR) + "/scenes/vdb/smoke_plume_96_f050.vdb";
inline const std::string kFire = std::string(BRUME_SOURCE_DIR) + "/scenes/vdb/fire_80_f036.vdb";

inline std::string scratch(const std::string& name) {
  const std::filesystem::path folder = std::filesystem::path(BRUME_TEST_OUTPUT_DIR) / "vdb";
  std::filesystem::create_directories(folder);
  return (folder / name).string();
}

inline std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

constexpr std::uint32_t kDefaultCompression = openvdb::io::COMPRESS_ACTIVE_MASK | openvdb::io::COMPRESS_ZIP;

/// Writes the grids and returns the path.
inline std::string write_vdb(const std::string& name, const openvdb::GridCPtrVec& grids,
                             std::uint32_t compression = kDefaultCompression, bool with_statistics = true) {
  openvdb::initialize();
  const std::string path = scratch(name);
  openvdb::io::File file(path);
  file.setCompression(compression);
  file.setGridStatsMetadataEnabled(with_statistics);
  file.write(grids);
  return path;
}

inline openvdb::FloatGrid::Ptr named(openvdb::FloatGrid::Ptr grid, const std::string& name = "density") {
  grid->setName(name);
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  return grid;
}

/// The density of the smoke file, read by OpenVDB itself.
inline openvdb::FloatGrid::Ptr read_with_openvdb(const std::string& path, const std::string& name) {
  openvdb::initialize();
  openvdb::io::File file(path);
  file.open(/*delayLoad=*/false);
  return openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid(name));
}

/// Random voxels in [-50, 50]^3, about half of them in clusters, and some tiles of 8^3.
inline openvdb::FloatGrid::Ptr random_grid(unsigned seed) {
  std::mt19937 rng(seed);
  std::uniform_int_distribution<int> place(-50, 50), near(-3, 3);
  std::uniform_real_distribution<float> value(0.0f, 2.0f);
  auto grid = openvdb::FloatGrid::create(0.0f);
  auto accessor = grid->getAccessor();
  for (int i = 0; i < 6; ++i)
    grid->tree().addTile(1, openvdb::Coord(place(rng), place(rng), place(rng)), value(rng), true);
  for (int i = 0; i < 1500; ++i) {
    const openvdb::Coord at(place(rng), place(rng), place(rng));
    for (int k = 0; k < 4; ++k) accessor.setValue(at.offsetBy(near(rng), near(rng), near(rng)), value(rng));
  }
  return named(grid);
}

/// What the readers make of a float tree, without a file between.
inline VoxelBlocks blocks_of(const openvdb::FloatGrid& grid) {
  VoxelBlocks blocks;
  for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
    LeafBlock& block = blocks.leaves.emplace_back();
    block.origin = {leaf->origin().x(), leaf->origin().y(), leaf->origin().z()};
    std::copy_n(leaf->buffer().data(), LeafBlock::kVoxels, block.values.begin());
    for (openvdb::Index w = 0; w < 8; ++w) block.active[w] = leaf->getValueMask().getWord<openvdb::Index64>(w);
  }
  auto tile = grid.tree().cbeginValueAll();
  tile.setMaxDepth(decltype(tile)::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    const openvdb::CoordBBox box = tile.getBoundingBox();
    if (tile.isValueOn() || *tile != grid.background())
      blocks.tiles.push_back({{box.min().x(), box.min().y(), box.min().z()}, box.dim().x(), *tile, tile.isValueOn()});
  }
  return blocks;
}

}  // namespace brume::test
