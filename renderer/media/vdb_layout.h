// The structure of a .vdb file (format versions 222 to 224), read and checked without OpenVDB.
//
// OpenVDB 10's own reader trusts the file: counts from it are allocated and looped over unchecked, and a damaged chunk
// size makes it write past its buffers. So Brume walks the file itself, every count and size checked against the bytes
// that are there, and leaves to OpenVDB the decompression of chunks and the conversion of level sets (vdb_file.cpp).
// Format: openvdb/io/Archive.cc, io/Compression.h, tree/RootNode.h, InternalNode.h, LeafNode.h of release 10.0.
#pragma once

#include <cstddef>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/core/transform.h"
#include "renderer/media/brick_grid.h"  // VoxelIndex

namespace brume::vdb {

/// Thrown by everything below when the bytes make no sense; does not leave renderer/media.
struct Damaged {
  std::string what;  ///< "the tree ends early"
};
/// More bytes were asked for than there are.
struct EndsEarly : Damaged {};

/// Walks along bytes; every step is checked.
class Cursor {
 public:
  explicit Cursor(std::span<const std::byte> data, std::uint64_t position = 0) : data_(data), position_(position) {}

  std::uint64_t position() const { return position_; }
  std::span<const std::byte> take(std::uint64_t bytes);
  template <class T> T get() {
    T value;
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
    return value;
  }
  std::string get_string();

 private:
  std::span<const std::byte> data_;
  std::uint64_t position_;
};

/// One named value of a grid's metadata, undecoded.
struct MetaValue {
  std::string name, type;
  std::vector<std::byte> bytes;
};
using Metadata = std::vector<MetaValue>;

/// The value of `name`, if it is there, has this type and fits.
std::optional<std::string> meta_string(const Metadata& metadata, std::string_view name);
std::optional<std::int64_t> meta_int64(const Metadata& metadata, std::string_view name);
std::optional<VoxelIndex> meta_vec3i(const Metadata& metadata, std::string_view name);

/// Where a grid lies in the file.
struct GridEntry {
  std::string unique_name;                       ///< as references within the file use it
  std::string name;                              ///< for people: "density", or "density[1]" where a name occurs twice
  std::string tree;                              ///< "Tree_float_5_4_3"
  bool half = false;                             ///< real values are stored in 16 bits
  std::string parent;                            ///< unique name of the grid whose tree this one shares, or empty
  std::uint64_t begin = 0, blocks = 0, end = 0;  ///< offsets in the file; `blocks` begins the voxel values
};

/// What stands in front of the grids.
struct FileHead {
  std::uint32_t version = 0;
  bool has_offsets = false;  ///< false: written to a stream, the offsets of the entries are all 0
  std::int32_t grids = 0;
};
FileHead read_file_head(Cursor& c);
GridEntry read_grid_entry(Cursor& c);

/// What stands in front of a grid's tree.
struct GridHead {
  std::uint32_t compression = 0;  ///< Compression flags
  Metadata metadata;
  bool affine = false;
  Affined index_to_world;  ///< only when affine
};
enum Compression : std::uint32_t { kZip = 1, kActiveMask = 2, kBlosc = 4 };
GridHead read_grid_head(Cursor& c);

}  // namespace brume::vdb
