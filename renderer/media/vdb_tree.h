// The tree of one grid of a .vdb file: its structure and its values. See vdb_layout.h.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "renderer/media/brick_grid.h"
#include "renderer/media/vdb_layout.h"

namespace brume::vdb {

/// How a tree's values are stored.
enum class Value { Float, Double, Int32, Int64, Bool, Mask, Vec3s, Vec3d, Vec3i };
struct TreeFormat {
  Value value = Value::Float;
  bool half = false;
  std::uint32_t compression = 0;
};
/// Nothing when the walk below cannot read such trees (points, strings, unusual branching).
std::optional<Value> value_of_tree(std::string_view tree);
bool is_scalar(Value value);

struct LeafPlace {
  VoxelIndex origin;
  std::uint64_t begin = 0;  ///< of its values, as an offset in the data
};
struct Tree {
  float background = 0;
  std::vector<TileBlock> tiles;  ///< the active ones, and the inactive ones whose value is not the background
  std::vector<LeafPlace> leaves;
  std::uint64_t active_voxels = 0;
  VoxelIndex active_min, active_max;  ///< only when active_voxels > 0
};
/// Reads everything but the values of the leaves.
Tree read_topology(Cursor& c, const TreeFormat& format);
/// Finds and checks where the values of each leaf lie; `c` stands at the first of them and is left behind the last.
void find_leaf_values(Cursor& c, const TreeFormat& format, Tree& tree);
/// Decodes one leaf of a scalar tree. Any thread.
void read_leaf(std::span<const std::byte> data, const TreeFormat& format, const Tree& tree, const LeafPlace& place,
               LeafBlock& leaf);

/// Decompresses exactly `out.size()` bytes; `chunk` is the compressed data behind their 8-byte length, which is
/// included. False when it is damaged. Throws Damaged, naming the codec, when OpenVDB was built without it.
/// In vdb_file.cpp.
bool decompress(bool blosc, std::span<const std::byte> chunk, std::span<std::byte> out);

}  // namespace brume::vdb
