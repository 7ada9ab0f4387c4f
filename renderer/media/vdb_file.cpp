#include "renderer/media/vdb_file.h"

#include <openvdb/io/Compression.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetUtil.h>

#include <algorithm>
#include <cctype>
#include <istream>
#include <mutex>
#include <streambuf>

#include "renderer/core/parallel.h"
#include "renderer/media/grid_file.h"
#include "renderer/media/nanovdb_file.h"
#include "renderer/media/vdb_archive.h"
#include "renderer/media/vdb_tree.h"

namespace brume {
namespace vdb {
namespace {

/// Bytes in memory as a stream.
class MemoryBuffer : public std::streambuf {
 public:
  explicit MemoryBuffer(std::span<const std::byte> data) {
    // A get area is not written to.
    char* begin = const_cast<char*>(reinterpret_cast<const char*>(data.data()));
    setg(begin, begin, begin + data.size());
  }
};

/// Blosc trusts the header of a chunk, which tells its sizes once more.
bool blosc_sizes_agree(std::span<const std::byte> chunk, std::size_t unpacked) {
  constexpr std::size_t kLength = 8, kHeader = 16, kUnpackedAt = 4, kPackedAt = 12;
  if (chunk.size() < kLength + kHeader) return false;
  std::uint32_t header_unpacked, header_packed;
  std::memcpy(&header_unpacked, chunk.data() + kLength + kUnpackedAt, 4);
  std::memcpy(&header_packed, chunk.data() + kLength + kPackedAt, 4);
  return header_unpacked == unpacked && header_packed == chunk.size() - kLength;
}

}  // namespace

bool decompress(bool blosc, std::span<const std::byte> chunk, std::span<std::byte> out) {
  if (blosc ? !openvdb::io::Archive::hasBloscCompression() : !openvdb::io::Archive::hasZLibCompression())
    throw Damaged{std::string("it is compressed with ") + (blosc ? "Blosc" : "zlib") +
                  ", which this OpenVDB was built without"};
  if (blosc && !blosc_sizes_agree(chunk, out.size())) return false;
  MemoryBuffer buffer(chunk);
  std::istream stream(&buffer);
  try {
    char* to = reinterpret_cast<char*>(out.data());
    blosc ? openvdb::io::bloscFromStream(stream, to, out.size()) : openvdb::io::unzipFromStream(stream, to, out.size());
  } catch (const openvdb::Exception&) {
    return false;
  }
  return stream.good();
}

namespace {

std::string type_name(const GridEntry& entry) {
  constexpr std::string_view kBefore = "Tree_", kBehind = "_5_4_3";
  const std::string& t = entry.tree;
  if (!t.starts_with(kBefore) || !t.ends_with(kBehind) || t.size() <= kBefore.size() + kBehind.size())
    return clamped(t);
  return clamped(t.substr(kBefore.size(), t.size() - kBefore.size() - kBehind.size()));
}

/// Takes the active box from the metadata where it is there and makes sense.
bool box_from_metadata(const Metadata& metadata, GridInfo& info) {
  const auto count = meta_int64(metadata, "file_voxel_count");
  if (!count || *count < 0) return false;
  info.active_voxels = static_cast<std::uint64_t>(*count);
  if (*count == 0) return true;
  const auto low = meta_vec3i(metadata, "file_bbox_min"), high = meta_vec3i(metadata, "file_bbox_max");
  if (!low || !high || min(*low, *high) != *low) return false;
  info.index_min = *low, info.index_max = *high;
  return true;
}

void set_box(const Tree& tree, GridInfo& info) {
  info.active_voxels = tree.active_voxels;
  info.index_min = tree.active_min, info.index_max = tree.active_max;
  info.memory_bytes = tree.leaves.size() * bytes_per_brick(BrickLayout::Quad);
}

/// All that is known before the tree is read; `affine` grids of readable types are still without why_not.
GridInfo describe(const GridEntry& entry, const GridHead& head) {
  GridInfo info;
  info.name = entry.name;
  info.type = type_name(entry);
  info.grid_class = clamped(meta_string(head.metadata, "class").value_or("unknown"));
  info.codec = openvdb::io::compressionToString(head.compression);
  info.is_half = entry.half;
  info.affine = head.affine;
  const auto value = value_of_tree(entry.tree);
  if (entry.tree.starts_with("Tree_pt"))
    info.why_not = "holds points, not a density";
  else if (!value && entry.tree == info.type)
    info.why_not = "has an unusual tree (" + info.type + ")";
  else if (!value || !is_scalar(*value))
    info.why_not = "is of type " + info.type + ", not a scalar";
  return info;
}

/// A tree with its values; the bytes it came from are let go.
struct Voxels {
  float background = 0;
  VoxelBlocks blocks;
};

Voxels read_voxels(Archive& file, const GridEntry& entry, GridInfo& info, const LoadOptions& options) {
  const GridEntry& source = file.tree_of(entry);
  const auto data = file.bytes(source, false, part_of(options, 0.0f, 0.3f));
  Cursor c(data);
  const TreeFormat format{value_of_tree(source.tree).value(), source.half, read_grid_head(c).compression};
  Tree tree = read_topology(c, format);
  set_box(tree, info);
  stop_if_cancelled(options);
  find_leaf_values(c, format, tree);
  if (auto enough =
          check_memory(data.size() + tree.leaves.size() * (sizeof(LeafBlock) + bytes_per_brick(BrickLayout::Quad)));
      !enough)
    throw Damaged{enough.error().message};

  Voxels voxels{tree.background, {}};
  auto& leaves = voxels.blocks.leaves;
  leaves.resize(tree.leaves.size());
  constexpr int kChunk = 256;  // leaves: some milliseconds of unpacking
  const int chunks = static_cast<int>((leaves.size() + kChunk - 1) / kChunk);
  const LoadOptions rest = part_of(options, 0.3f, 1.0f);
  std::mutex mutex;
  int done = 0;
  std::optional<Damaged> damaged;
  parallel_for(chunks, [&](int chunk) {
    if (options.cancel.stop_requested()) return;
    std::optional<Damaged> problem;
    try {
      const std::size_t first = static_cast<std::size_t>(chunk) * kChunk;
      for (std::size_t i = first; i < std::min(first + kChunk, leaves.size()); ++i)
        read_leaf(data, format, tree, tree.leaves[i], leaves[i]);
    } catch (const Damaged& d) {
      problem = d;
    } catch (const std::exception& e) {
      problem = Damaged{clamped(e.what())};
    }
    const std::lock_guard lock(mutex);
    if (problem) damaged = problem;
    if (rest.progress) rest.progress(static_cast<float>(++done) / static_cast<float>(chunks));
  });
  stop_if_cancelled(options);
  if (damaged) throw Damaged(*damaged);
  voxels.blocks.tiles = std::move(tree.tiles);
  return voxels;
}

/// A signed distance field as OpenVDB wants it, and back as a fog volume: 1 inside, falling to 0 across the outer half
/// of the band.
VoxelBlocks fog_from_level_set(const Voxels& voxels) {
  const auto grid = openvdb::FloatGrid::create(voxels.background);
  for (const TileBlock& tile : voxels.blocks.tiles) {
    const openvdb::Index level = tile.size == 8 ? 1 : tile.size == 128 ? 2 : 3;
    grid->tree().addTile(level, {tile.origin.x, tile.origin.y, tile.origin.z}, tile.value, tile.active);
  }
  for (const LeafBlock& block : voxels.blocks.leaves) {
    auto* leaf = grid->tree().touchLeaf({block.origin.x, block.origin.y, block.origin.z});
    std::copy(block.values.begin(), block.values.end(), leaf->buffer().data());
    for (openvdb::Index w = 0; w < 8; ++w) leaf->getValueMask().getWord<openvdb::Index64>(w) = block.active[w];
  }
  openvdb::tools::sdfToFogVolume(*grid);

  const openvdb::FloatTree& tree = grid->tree();  // a new one
  VoxelBlocks fog;
  for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) {
    LeafBlock& block = fog.leaves.emplace_back();
    block.origin = {leaf->origin().x(), leaf->origin().y(), leaf->origin().z()};
    std::copy_n(leaf->buffer().data(), LeafBlock::kVoxels, block.values.begin());
    for (openvdb::Index w = 0; w < 8; ++w) block.active[w] = leaf->getValueMask().getWord<openvdb::Index64>(w);
  }
  auto tile = tree.cbeginValueOn();
  tile.setMaxDepth(decltype(tile)::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    const openvdb::CoordBBox box = tile.getBoundingBox();
    fog.tiles.push_back({{box.min().x(), box.min().y(), box.min().z()}, box.dim().x(), *tile, true});
  }
  return fog;
}

GridInfo list_grid(Archive& file, const GridEntry& entry, bool scan) {
  const GridHead head = file.head(entry);
  GridInfo info = describe(entry, head);
  const bool readable = info.why_not.empty();
  const bool told = box_from_metadata(head.metadata, info);
  if (told) info.memory_bytes = *info.active_voxels / 300 * bytes_per_brick(BrickLayout::Quad);  // 300: a usual filling
  if (readable && scan) {
    const Voxels voxels = read_voxels(file, entry, info, {});
    scan_values(voxels.blocks, info);
  } else if (readable && !told) {
    const GridEntry& source = file.tree_of(entry);
    const auto data = file.bytes(source, true);
    Cursor c(data);
    const std::uint32_t compression = read_grid_head(c).compression;
    set_box(read_topology(c, {value_of_tree(source.tree).value(), source.half, compression}), info);
  }
  if (!told && !readable) info.active_voxels = std::nullopt;
  complete_info(info, head.index_to_world);
  return info;
}

std::vector<GridInfo> list(const std::string& path, Archive& file, bool scan) {
  std::vector<GridInfo> infos;
  for (const GridEntry& entry : file.entries()) {
    try {
      infos.push_back(list_grid(file, entry, scan));
    } catch (const Damaged& damaged) {
      refuse_damaged(path, entry.name, damaged);
    }
  }
  return infos;
}

Result<LoadedGrid> load(const std::string& path, const std::string& name, const LoadOptions& options) {
  Archive file(path);
  const std::vector<GridInfo> infos = list(path, file, false);
  const std::size_t chosen = choose_grid(path, infos, name);
  const GridEntry& entry = file.entries()[chosen];
  GridInfo info = infos[chosen];
  std::vector<std::string> warnings;
  const std::string grid_of_file = name_of(info, path);

  Affined index_to_world;
  Voxels voxels;
  try {
    index_to_world = file.head(entry).index_to_world;
    voxels = read_voxels(file, entry, info, part_of(options, 0.0f, 0.6f));
  } catch (const Damaged& damaged) {
    refuse_damaged(path, entry.name, damaged);
  }
  scan_values(voxels.blocks, info);
  info.world_bounds = {};
  complete_info(info, index_to_world);
  stop_if_cancelled(options);

  // Some programs forget the class; a distance field still shows by its background, the width of its band, and by
  // values below 0 that do not go beyond that width.
  const bool said = info.grid_class == "level set";
  const bool looks_like_one =
      info.grid_class == "unknown" && voxels.background > 0 && info.min < 0 && info.min >= -1.001f * voxels.background;
  if (said || looks_like_one) {
    if (!(voxels.background > 0) || !std::isfinite(voxels.background))
      refuse(grid_of_file + " is a level set whose background, " + std::to_string(voxels.background) +
             ", is not the width of a band; convert it to a fog volume first");
    warnings.push_back(grid_of_file + (said ? " is a level set" : " looks like a level set") +
                       " and was turned into a fog volume: 1 inside, 0 outside");
    voxels = {0, fog_from_level_set(voxels)};
  } else if (voxels.background != 0) {
    clear_background(voxels.blocks, voxels.background);
    warnings.push_back(background_warning(path, info, voxels.background));
  }
  stop_if_cancelled(options);
  return finish_grid(path, std::move(voxels.blocks), std::move(info), index_to_world, std::move(warnings),
                     part_of(options, 0.6f, 1.0f));
}

}  // namespace
}  // namespace vdb

namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool is_nanovdb(const std::string& path) { return lower(path).ends_with(".nvdb"); }

bool names_any(const GridInfo& grid, std::initializer_list<std::string_view> words) {
  const std::string name = lower(grid.name);
  return std::any_of(words.begin(), words.end(),
                     [&](std::string_view word) { return name.find(word) != std::string::npos; });
}

template <class Test> std::optional<std::string> first_usable(std::span<const GridInfo> grids, const Test& test) {
  for (const GridInfo& grid : grids)
    if (grid.usable && test(grid)) return grid.name;
  return std::nullopt;
}

bool is_emission(const GridInfo& grid) { return names_any(grid, {"flame", "fire", "emission", "burn", "blaze"}); }

}  // namespace

Result<std::vector<GridInfo>> list_grids(const std::string& path, bool scan_values) {
  if (is_nanovdb(path)) return list_nanovdb_grids(path, scan_values);
  return guard_file(path, [&]() -> Result<std::vector<GridInfo>> {
    vdb::Archive file(path);
    return vdb::list(path, file, scan_values);
  });
}

Result<LoadedGrid> load_grid(const std::string& path, const std::string& grid_name, const LoadOptions& options) {
  if (is_nanovdb(path)) return load_nanovdb_grid(path, grid_name, options);
  return guard_file(path, [&] { return vdb::load(path, grid_name, options); });
}

std::optional<std::string> guess_density_grid(std::span<const GridInfo> grids) {
  const auto other = [](const GridInfo& g) {
    return is_emission(g) ||
           names_any(g, {"shadow", "temperature", "heat", "velocity", "vel", "fuel", "color", "colour"});
  };
  if (auto g = first_usable(grids, [](const GridInfo& i) { return lower(i.name) == "density"; })) return g;
  if (auto g = first_usable(grids, [](const GridInfo& i) { return names_any(i, {"density"}); })) return g;
  if (auto g = first_usable(grids, [](const GridInfo& i) { return names_any(i, {"soot", "smoke"}); })) return g;
  if (auto g = first_usable(grids, [&](const GridInfo& i) { return i.grid_class == "fog volume" && !other(i); }))
    return g;
  return first_usable(grids, [&](const GridInfo& i) { return !other(i); });
}

std::optional<std::string> guess_emission_grid(std::span<const GridInfo> grids) {
  return first_usable(grids, is_emission);
}

std::optional<std::string> guess_temperature_grid(std::span<const GridInfo> grids) {
  return first_usable(grids, [](const GridInfo& i) { return names_any(i, {"temperature", "heat"}); });
}

}  // namespace brume
