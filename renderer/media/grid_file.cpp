#include "renderer/media/grid_file.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <mutex>
#include <system_error>

#include "renderer/core/parallel.h"

namespace brume {
namespace {

std::string list_names(std::span<const GridInfo> grids, bool only_usable) {
  std::string names;
  for (const GridInfo& g : grids) {
    if (only_usable && !g.usable) continue;
    names += (names.empty() ? "" : ", ") + g.name;
  }
  return names.empty() ? "none" : clamped(names);
}

std::string voxels(std::uint64_t n) { return std::to_string(n) + (n == 1 ? " voxel" : " voxels"); }

}  // namespace

std::string name_of(const GridInfo& grid, const std::string& path) {
  return "grid " + in_quotes(clamped(grid.name)) + " of " + in_quotes(path);
}

std::string clamped(std::string text) {
  constexpr std::size_t kLongest = 300;
  if (text.size() > kLongest) text.replace(kLongest - 3, std::string::npos, "...");
  return text;
}

std::string in_quotes(const std::string& text) { return "\"" + text + "\""; }

void refuse(std::string message) { throw FileProblem{bad_input(std::move(message))}; }

void stop_if_cancelled(const LoadOptions& options) {
  if (options.cancel.stop_requested()) throw FileProblem{loading_cancelled()};
}

InputFile::InputFile(const std::string& path) : path_(path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(fs::path(path), error);
  if (status.type() == fs::file_type::not_found) refuse(in_quotes(path) + " does not exist");
  if (status.type() == fs::file_type::none) refuse(in_quotes(path) + " cannot be opened: " + error.message());
  if (status.type() == fs::file_type::directory) refuse(in_quotes(path) + " is a directory, not a grid file");
  if (status.type() != fs::file_type::regular) refuse(in_quotes(path) + " is not a regular file");
  stream_.open(fs::path(path), std::ios::binary);
  if (!stream_) refuse(in_quotes(path) + " cannot be opened: " + std::generic_category().message(errno));
  stream_.seekg(0, std::ios::end);
  const std::streamoff end = stream_.tellg();
  if (!stream_ || end < 0) refuse(in_quotes(path) + " cannot be read");
  if (end == 0) refuse(in_quotes(path) + " is empty: it has 0 bytes");
  size_ = static_cast<std::uint64_t>(end);
}

LargeArray<std::byte> InputFile::read(std::uint64_t offset, std::uint64_t bytes, const LoadOptions& options) {
  constexpr std::uint64_t kPiece = 16 << 20;
  offset = std::min(offset, size_);
  bytes = std::min(bytes, size_ - offset);
  if (auto enough = check_memory(bytes); !enough) refuse(in_quotes(path_) + ": " + enough.error().message);
  LargeArray<std::byte> data(bytes);
  stream_.seekg(static_cast<std::streamoff>(offset));
  for (std::uint64_t done = 0; done < bytes;) {
    stop_if_cancelled(options);
    const std::uint64_t piece = std::min(kPiece, bytes - done);
    // Through char, which may alias anything.
    stream_.read(reinterpret_cast<char*>(data.data() + done), static_cast<std::streamsize>(piece));
    if (!stream_) refuse(in_quotes(path_) + " cannot be read to its end; has it changed meanwhile?");
    done += piece;
    if (options.progress) options.progress(static_cast<float>(done) / static_cast<float>(bytes));
  }
  return data;
}

void complete_info(GridInfo& info, const Affined& index_to_world) {
  const bool empty = info.active_voxels == std::uint64_t{0};
  bool invertible = false;
  if (info.affine) {
    const Affined& m = index_to_world;
    info.voxel_size = {length(m.axis(0)), length(m.axis(1)), length(m.axis(2))};
    invertible = inverse(m).has_value();
    if (info.active_voxels && !empty)
      info.world_bounds = transform_bounds(m, {Vec3d(info.index_min) - Vec3d(0.5), Vec3d(info.index_max) + Vec3d(0.5)});
  }
  if (info.why_not.empty() && !info.affine)
    info.why_not = "has a transform that is not affine (a frustum); resample it to uniform voxels";
  if (info.why_not.empty() && !invertible) info.why_not = "has a transform that cannot be inverted";
  if (info.why_not.empty() && empty) info.why_not = "is empty: it has no active voxel";
  info.usable = info.why_not.empty();
}

void scan_values(const VoxelBlocks& blocks, GridInfo& info) {
  struct Range {
    float low = std::numeric_limits<float>::infinity(), high = -low;
    std::uint64_t non_finite = 0, negative = 0;
    void add(float v, std::uint64_t n) {
      if (!std::isfinite(v)) {
        non_finite += n;
        return;
      }
      low = std::min(low, v), high = std::max(high, v);
      negative += v < 0 ? n : 0;
    }
  } all;
  constexpr std::size_t kChunk = 1024;
  std::mutex mutex;
  parallel_for(static_cast<int>((blocks.leaves.size() + kChunk - 1) / kChunk), [&](int c) {
    Range some;
    const std::size_t first = static_cast<std::size_t>(c) * kChunk;
    for (std::size_t i = first; i < std::min(first + kChunk, blocks.leaves.size()); ++i)
      for (int e = 0; e < LeafBlock::kVoxels; ++e)
        if (blocks.leaves[i].is_active(e)) some.add(blocks.leaves[i].values[static_cast<unsigned>(e)], 1);
    const std::lock_guard lock(mutex);
    all.low = std::min(all.low, some.low), all.high = std::max(all.high, some.high);
    all.non_finite += some.non_finite, all.negative += some.negative;
  });
  for (const TileBlock& tile : blocks.tiles) {
    const auto size = static_cast<std::uint64_t>(tile.size);
    if (tile.active) all.add(tile.value, size * size * size);
  }
  info.scanned = true;
  if (all.low <= all.high) info.min = all.low, info.max = all.high;
  info.non_finite = all.non_finite, info.negative = all.negative;
}

void clear_background(VoxelBlocks& blocks, float background) {
  for (LeafBlock& leaf : blocks.leaves)
    for (int e = 0; e < LeafBlock::kVoxels; ++e) {
      float& v = leaf.values[static_cast<unsigned>(e)];
      if (!leaf.is_active(e) && same_value(v, background)) v = 0;
    }
}

std::string background_warning(const std::string& path, const GridInfo& info, float background) {
  return name_of(info, path) + " has the background value " + std::to_string(background) +
         "; outside its active voxels 0 is used instead";
}

std::size_t choose_grid(const std::string& path, std::span<const GridInfo> grids, const std::string& name) {
  const auto find = [&](const std::string& wanted) {
    return static_cast<std::size_t>(
        std::find_if(grids.begin(), grids.end(), [&](const GridInfo& g) { return g.name == wanted; }) - grids.begin());
  };
  std::size_t i = find(name);
  if (i == grids.size()) i = find(name + "[0]");  // the first of several with the name
  if (i == grids.size())
    refuse(in_quotes(path) + " has no grid " + in_quotes(clamped(name)) + "; it has " + list_names(grids, false));
  if (!grids[i].usable)
    refuse("grid " + in_quotes(clamped(name)) + " of " + in_quotes(path) + " " + grids[i].why_not +
           "; usable grids: " + list_names(grids, true));
  return i;
}

Result<LoadedGrid> finish_grid(const std::string& path, VoxelBlocks blocks, GridInfo info,
                               const Affined& index_to_world, std::vector<std::string> warnings,
                               const LoadOptions& options) {
  auto built = build_brick_grid(std::move(blocks), options);
  const std::string name = name_of(info, path);
  if (!built) {
    Error error = built.error();
    if (error.code != ErrorCode::Cancelled) error.message = name + ": " + error.message;
    return error;
  }
  const auto grid = std::make_shared<const BrickGrid>(std::move(*built));
  if (const auto n = grid->non_finite_voxels())
    warnings.push_back(name + ": " + voxels(n) + " not finite (NaN or infinite), taken as 0");
  if (const auto n = grid->negative_voxels()) warnings.push_back(name + ": " + voxels(n) + " below 0, taken as 0");
  if (grid->max_value() == 0) warnings.push_back(name + ": every voxel is 0, so nothing will be seen");
  info.memory_bytes = grid->memory_bytes();
  return LoadedGrid{grid, index_to_world, std::move(info), std::move(warnings)};
}

}  // namespace brume
