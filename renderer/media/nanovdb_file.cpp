#include "renderer/media/nanovdb_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "renderer/core/parallel.h"
#include "renderer/media/grid_file.h"
#include "renderer/media/vdb_layout.h"
#include "renderer/media/vdb_tree.h"

#if __has_include(<nanovdb/NanoVDB.h>)
#include <nanovdb/NanoVDB.h>

namespace brume {
namespace {

using vdb::Cursor;
using vdb::Damaged;

constexpr std::uint64_t kMagicStart = 0x4244566f6e614eULL;  // "NanoVDB", followed by a digit
constexpr std::uint32_t kAbi = 32;                          // major version of NanoVDB's memory layout
constexpr std::uint64_t kAlignment = 32;                    // of every node in a grid
enum Codec : std::uint16_t { kNone = 0, kZip = 1, kBlosc = 2 };

/// Bytes that may be looked at as NanoVDB's structs.
class AlignedBytes {
 public:
  explicit AlignedBytes(std::uint64_t size) : blocks_(size / sizeof(Block) + 1), size_(size) {}
  std::span<std::byte> span() { return {blocks_.data()->bytes, size_}; }

  /// `count` structs from `offset` on; throws Damaged when they are not all there.
  template <class T> const T* at(std::uint64_t offset, std::uint64_t count = 1) const {
    if (offset > size_ || offset % kAlignment != 0 || count > (size_ - offset) / sizeof(T))
      throw Damaged{"its nodes lie outside it"};
    return reinterpret_cast<const T*>(blocks_.data()->bytes + offset);
  }

 private:
  struct alignas(64) Block {
    std::byte bytes[64];
  };
  std::vector<Block> blocks_;
  std::uint64_t size_;
};

/// One grid of the file. The description is the file's "MetaData" of 176 bytes (nanovdb/util/IO.h).
struct Entry {
  GridInfo info;
  nanovdb::GridType type = nanovdb::GridType::Unknown;
  std::uint16_t codec = kNone;
  std::uint64_t grid_size = 0, begin = 0, size = 0;
};

const char* type_name(nanovdb::GridType type) {
  switch (type) {
    case nanovdb::GridType::Float:
      return "float";
    case nanovdb::GridType::Double:
      return "double";
    case nanovdb::GridType::Int32:
      return "int32";
    case nanovdb::GridType::Fp4:
      return "Fp4";
    case nanovdb::GridType::Fp8:
      return "Fp8";
    case nanovdb::GridType::Fp16:
      return "Fp16";
    case nanovdb::GridType::FpN:
      return "FpN";
    case nanovdb::GridType::Vec3f:
      return "vec3s";
    case nanovdb::GridType::Vec3d:
      return "vec3d";
    default:
      return "other";
  }
}

const char* class_name(std::uint32_t grid_class) {
  constexpr const char* kNames[] = {"unknown", "level set", "fog volume", "staggered"};
  return grid_class < 4 ? kNames[grid_class] : "unknown";
}

/// Calls f(type tag) with the build type of the grid; false when Brume does not read the type.
template <class F> bool with_type(nanovdb::GridType type, const F& f) {
  switch (type) {
    case nanovdb::GridType::Float:
      f(float{});
      return true;
    case nanovdb::GridType::Double:
      f(double{});
      return true;
    case nanovdb::GridType::Int32:
      f(std::int32_t{});
      return true;
    case nanovdb::GridType::Fp4:
      f(nanovdb::Fp4{});
      return true;
    case nanovdb::GridType::Fp8:
      f(nanovdb::Fp8{});
      return true;
    case nanovdb::GridType::Fp16:
      f(nanovdb::Fp16{});
      return true;
    case nanovdb::GridType::FpN:
      f(nanovdb::FpN{});
      return true;
    default:
      return false;
  }
}

Entry read_entry(Cursor& c, std::uint16_t codec) {
  Entry e;
  e.codec = codec;
  e.grid_size = c.get<std::uint64_t>();
  e.size = c.get<std::uint64_t>();
  c.take(8);  // hash of the name
  e.info.active_voxels = c.get<std::uint64_t>();
  e.type = static_cast<nanovdb::GridType>(c.get<std::uint32_t>());
  e.info.grid_class = class_name(c.get<std::uint32_t>());
  c.take(6 * 8);  // box in world space
  const auto get_index = [&c] {
    const auto x = c.get<std::int32_t>(), y = c.get<std::int32_t>(), z = c.get<std::int32_t>();
    return VoxelIndex(x, y, z);
  };
  e.info.index_min = get_index();
  e.info.index_max = get_index();
  c.take(3 * 8);  // voxel size
  const auto name_bytes = c.get<std::uint32_t>();
  c.take(4 * 4 + 3 * 4 + 2 * 2 + 4);  // numbers of nodes and tiles, codec, padding, version
  const auto name = c.take(name_bytes);
  const char* text = reinterpret_cast<const char*>(name.data());
  e.info.name = clamped(std::string(text, std::find(text, text + name.size(), '\0')));
  e.info.type = type_name(e.type);
  e.info.codec = codec == kZip ? "zip" : codec == kBlosc ? "blosc" : "none";
  if (!with_type(e.type, [](auto) {})) e.info.why_not = "is of type " + e.info.type + ", not a scalar that Brume reads";
  if (e.info.grid_class == "level set")
    e.info.why_not = "is a level set; convert it to a fog volume, or load it from a .vdb file";
  return e;
}

/// A file is a row of segments, each with descriptions of some grids followed by the grids.
std::vector<Entry> read_entries(InputFile& file) {
  constexpr std::uint64_t kHeader = 16, kLongestDescriptions = 16 << 20;
  std::vector<Entry> entries;
  for (std::uint64_t at = 0; at < file.size();) {
    const auto data = file.read(at, kLongestDescriptions);
    Cursor c(data);
    if (data.size() < kHeader || (c.get<std::uint64_t>() & 0xFFFFFFFFFFFFFFULL) != kMagicStart)
      throw Damaged{at == 0 ? "it does not begin like a .nvdb file" : "it has no further grid where one should be"};
    const std::uint32_t abi = c.get<std::uint32_t>() >> 21;
    if (abi != kAbi)
      throw Damaged{"its memory layout is version " + std::to_string(abi) + ", and Brume reads version 32"};
    const auto count = c.get<std::uint16_t>(), codec = c.get<std::uint16_t>();
    const std::size_t first = entries.size();
    for (int i = 0; i < count; ++i) entries.push_back(read_entry(c, codec));
    at += c.position();
    for (std::size_t i = first; i < entries.size(); ++i) {
      entries[i].begin = at;
      if (entries[i].size > file.size() - at) throw Damaged{"its data end early, so it is cut off or damaged"};
      at += entries[i].size;
    }
  }
  if (entries.empty()) throw Damaged{"it holds no grids"};
  return entries;
}

AlignedBytes read_grid(const std::string& path, InputFile& file, const Entry& e, const LoadOptions& options) {
  constexpr std::uint64_t kBloscPiece = 1 << 30;
  constexpr std::uint64_t kBestRatio = 1100;  // zlib's best is 1032, of zeros
  if (e.codec == kNone ? e.size != e.grid_size : e.grid_size / kBestRatio > e.size) throw Damaged{"its size is wrong"};
  if (auto enough = check_memory(e.grid_size); !enough) refuse(name_of(e.info, path) + ": " + enough.error().message);
  const auto data = file.read(e.begin, e.size, options);
  AlignedBytes grid(e.grid_size);
  if (e.codec == kNone) {
    std::copy(data.begin(), data.end(), grid.span().begin());
  } else if (e.codec == kZip || e.codec == kBlosc) {
    Cursor c(data);
    for (std::uint64_t done = 0; done < e.grid_size;) {
      const std::uint64_t piece = e.codec == kZip ? e.grid_size : std::min(kBloscPiece, e.grid_size - done);
      Cursor length_at = c;
      const auto length = c.get<std::uint64_t>();
      c.take(length);
      if (!vdb::decompress(e.codec == kBlosc, length_at.take(8 + length), grid.span().subspan(done, piece)))
        throw Damaged{"it cannot be decompressed"};
      done += piece;
    }
  } else {
    throw Damaged{"it has an unknown kind of compression"};
  }
  return grid;
}

Affined index_to_world(const AlignedBytes& grid) {
  const nanovdb::Map& map = grid.at<nanovdb::GridData>(0)->mMap;
  Affined m;
  for (int i = 0; i < 3; ++i) m.row[i] = {map.mMatD[3 * i], map.mMatD[3 * i + 1], map.mMatD[3 * i + 2]};
  m.offset = {map.mVecD[0], map.mVecD[1], map.mVecD[2]};
  return m;
}

/// Reads the nodes level by level as they lie, following no pointer; positions are made multiples of the node's size.
template <class Build> class NodeReader {
 public:
  NodeReader(const AlignedBytes& grid, float& background, VoxelBlocks& blocks) : grid_(grid), blocks_(blocks) {
    const auto* tree = grid.at<nanovdb::TreeData<3>>(kTree);
    const auto* root = node<typename nanovdb::NanoRoot<Build>::DataType>(tree->mNodeOffset[3], 1);
    background = background_ = static_cast<float>(root->mBackground);
    using Tile = typename std::remove_reference_t<decltype(*root)>::Tile;
    const Tile* tiles = node<Tile>(tree->mNodeOffset[3] + sizeof(*root), root->mTableSize);
    for (std::uint32_t i = 0; i < root->mTableSize; ++i)
      if (!tiles[i].isChild()) add_tile(tiles[i].origin(), 4096, tiles[i].value, tiles[i].state != 0);
    internal<nanovdb::NanoUpper<Build>>(tree->mNodeOffset[2], tree->mNodeCount[2], 128);
    internal<nanovdb::NanoLower<Build>>(tree->mNodeOffset[1], tree->mNodeCount[1], 8);
    leaves(tree->mNodeOffset[0], tree->mNodeCount[0]);
  }

 private:
  static constexpr std::uint64_t kTree = sizeof(nanovdb::GridData);

  template <class T> const T* node(std::uint64_t offset, std::uint64_t count) const {
    if (offset > std::uint64_t{1} << 48) throw Damaged{"its nodes lie outside it"};  // so that the sum cannot wrap
    return grid_.at<T>(kTree + offset, count);
  }

  template <class C> static VoxelIndex origin(const C& coord, int size) {
    return {coord[0] & -size, coord[1] & -size, coord[2] & -size};
  }

  template <class C, class V> void add_tile(const C& coord, int size, V value, bool active) {
    const float v = static_cast<float>(value);
    if (active || !same_value(v, background_)) blocks_.tiles.push_back({origin(coord, size), size, v, active});
  }

  template <class Node> void internal(std::uint64_t offset, std::uint32_t count, int child_size) {
    constexpr int kLog2 = static_cast<int>(Node::LOG2DIM), kLow = (1 << kLog2) - 1;
    const auto* nodes = node<typename Node::DataType>(offset, count);
    for (std::uint32_t k = 0; k < count; ++k) {
      const VoxelIndex low = origin(nodes[k].mBBox[0], child_size << kLog2);
      for (int n = 0; n < 1 << (3 * kLog2); ++n) {
        const auto bit = static_cast<std::uint32_t>(n);
        if (nodes[k].mChildMask.isOn(bit)) continue;
        const VoxelIndex at = low + VoxelIndex(n >> (2 * kLog2), n >> kLog2 & kLow, n & kLow) * child_size;
        add_tile(at, child_size, nodes[k].mTable[n].value, nodes[k].mValueMask.isOn(bit));
      }
    }
  }

  void leaves(std::uint64_t offset, std::uint32_t count) {
    using Leaf = typename nanovdb::NanoLeaf<Build>::DataType;
    if constexpr (Leaf::FIXED_SIZE) {
      const Leaf* first = node<Leaf>(offset, count);
      resize(count);
      parallel_for(static_cast<int>((count + 255) / 256), [&](int c) {
        for (std::uint32_t i = static_cast<std::uint32_t>(c) * 256;
             i < std::min(count, (static_cast<std::uint32_t>(c) + 1) * 256); ++i)
          copy(first[i], blocks_.leaves[i]);
      });
    } else {
      std::uint64_t at = offset;  // FpN: each leaf has a size of its own
      for (std::uint32_t i = 0; i < count; ++i) {
        const Leaf* leaf = node<Leaf>(at, 1);
        const std::uint64_t bytes = leaf->memUsage();
        node<std::byte>(at, bytes);
        copy(*leaf, blocks_.leaves.emplace_back());
        at += bytes;
      }
    }
  }

  void resize(std::uint32_t count) {
    if (auto enough = check_memory(std::uint64_t{count} * sizeof(LeafBlock)); !enough)
      throw Damaged{enough.error().message};
    blocks_.leaves.resize(count);
  }

  template <class Leaf> static void copy(const Leaf& from, LeafBlock& to) {
    to.origin = origin(from.mBBoxMin, LeafBlock::kSize);
    to.active.fill(0);
    for (unsigned n = 0; n < LeafBlock::kVoxels; ++n) {
      to.values[n] = static_cast<float>(from.getValue(n));
      if (from.mValueMask.isOn(n)) to.active[n / 64] |= std::uint64_t{1} << (n % 64);
    }
  }

  const AlignedBytes& grid_;
  VoxelBlocks& blocks_;
  float background_ = 0;
};

struct Loaded {
  float background = 0;
  VoxelBlocks blocks;
  Affined map;
};

/// Throws Damaged, FileProblem.
Loaded read_voxels(const std::string& path, InputFile& file, Entry& e, const LoadOptions& options) {
  Loaded loaded;
  const AlignedBytes grid = read_grid(path, file, e, options);
  loaded.map = index_to_world(grid);
  with_type(e.type, [&](auto build) { NodeReader<decltype(build)>(grid, loaded.background, loaded.blocks); });
  stop_if_cancelled(options);
  return loaded;
}

template <class F> auto guard(const std::string& path, const F& f) -> decltype(f()) {
  return guard_file(path, [&]() -> decltype(f()) {
    try {
      return f();
    } catch (const Damaged& damaged) {
      refuse(in_quotes(path) + " cannot be read: " + damaged.what);
    }
  });
}

std::vector<GridInfo> infos_of(const std::string& path, InputFile& file, std::vector<Entry>& entries, bool scan) {
  std::vector<GridInfo> infos;
  for (Entry& e : entries) {
    Affined map;
    if (scan && e.info.why_not.empty()) {
      const Loaded loaded = read_voxels(path, file, e, {});
      map = loaded.map;
      scan_values(loaded.blocks, e.info);
    } else if (e.codec == kNone) {
      AlignedBytes head(sizeof(nanovdb::GridData));
      const auto data = file.read(e.begin, std::min<std::uint64_t>(e.size, sizeof(nanovdb::GridData)));
      std::copy(data.begin(), data.end(), head.span().begin());
      map = index_to_world(head);
    } else {
      map = index_to_world(read_grid(path, file, e, {}));
    }
    e.info.memory_bytes =
        e.info.active_voxels.value_or(0) / 300 * bytes_per_brick(BrickLayout::Quad);  // a usual filling
    complete_info(e.info, map);
    infos.push_back(e.info);
  }
  return infos;
}

}  // namespace

Result<std::vector<GridInfo>> list_nanovdb_grids(const std::string& path, bool scan_values) {
  return guard(path, [&]() -> Result<std::vector<GridInfo>> {
    InputFile file(path);
    std::vector<Entry> entries = read_entries(file);
    return infos_of(path, file, entries, scan_values);
  });
}

Result<LoadedGrid> load_nanovdb_grid(const std::string& path, const std::string& grid_name,
                                     const LoadOptions& options) {
  return guard(path, [&]() -> Result<LoadedGrid> {
    InputFile file(path);
    std::vector<Entry> entries = read_entries(file);
    const std::vector<GridInfo> infos = infos_of(path, file, entries, false);
    Entry& e = entries[choose_grid(path, infos, grid_name)];
    Loaded loaded = read_voxels(path, file, e, part_of(options, 0.0f, 0.4f));
    scan_values(loaded.blocks, e.info);
    std::vector<std::string> warnings;
    if (loaded.background != 0) {
      clear_background(loaded.blocks, loaded.background);
      warnings.push_back(background_warning(path, e.info, loaded.background));
    }
    return finish_grid(path, std::move(loaded.blocks), e.info, loaded.map, std::move(warnings),
                       part_of(options, 0.4f, 1.0f));
  });
}

}  // namespace brume

#else

namespace brume {

Result<std::vector<GridInfo>> list_nanovdb_grids(const std::string& path, bool) {
  return bad_input(in_quotes(path) + ": this program was built without NanoVDB; convert the file to .vdb");
}

Result<LoadedGrid> load_nanovdb_grid(const std::string& path, const std::string&, const LoadOptions&) {
  return bad_input(in_quotes(path) + ": this program was built without NanoVDB; convert the file to .vdb");
}

}  // namespace brume

#endif
