#include "renderer/media/vdb_layout.h"

#include <array>

namespace brume::vdb {
namespace {

constexpr std::int64_t kMagic = 0x56444220;
constexpr std::uint32_t kOldest = 222, kNewest = 224;
constexpr std::uint32_t kLongestString = 1 << 16;  // names and types; longer ones only in damaged files
constexpr std::string_view kHalfSuffix = "_HalfFloat";
constexpr char kSeparator = '\x1e';  // between a name and its number where several grids have the name

template <class T> std::optional<T> meta_value(const Metadata& metadata, std::string_view name, std::string_view type) {
  for (const MetaValue& m : metadata) {
    if (m.name != name || m.type != type || m.bytes.size() != sizeof(T)) continue;
    T value;
    std::memcpy(&value, m.bytes.data(), sizeof(T));
    return value;
  }
  return std::nullopt;
}

Metadata read_metadata(Cursor& c) {
  Metadata metadata;
  const auto count = c.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < count; ++i) {
    MetaValue m;
    m.name = c.get_string();
    m.type = c.get_string();
    const auto bytes = c.take(c.get<std::uint32_t>());
    m.bytes.assign(bytes.begin(), bytes.end());
    metadata.push_back(std::move(m));
  }
  return metadata;
}

Vec3d get_vec3d(Cursor& c) {
  const auto v = c.get<std::array<double, 3>>();
  return {v[0], v[1], v[2]};
}

/// The map from index to world space (openvdb/math/Maps.h), or nothing when it is a frustum.
std::optional<Affined> read_map(Cursor& c) {
  const std::string type = c.get_string();
  if (type == "UniformScaleMap" || type == "ScaleMap") {
    const Affined map = scaling(get_vec3d(c));
    c.take(4 * 24);  // what OpenVDB derives from the scale
    return map;
  }
  if (type == "TranslationMap") return translation(get_vec3d(c));
  if (type == "UniformScaleTranslateMap" || type == "ScaleTranslateMap") {
    const Vec3d offset = get_vec3d(c);
    Affined map = scaling(get_vec3d(c));
    map.offset = offset;
    c.take(4 * 24);
    return map;
  }
  if (type == "AffineMap" || type == "UnitaryMap") {
    const auto m = c.get<std::array<double, 16>>();  // for row vectors: world = (index, 1) * m
    Affined map;
    for (unsigned j = 0; j < 3; ++j) map.row[j] = {m[j], m[4 + j], m[8 + j]};
    map.offset = {m[12], m[13], m[14]};
    return map;
  }
  if (type == "NonlinearFrustumMap") {
    c.take(6 * 8 + 2 * 8);  // box, taper, depth
    read_map(c);
    return std::nullopt;
  }
  throw Damaged{"it has an unknown kind of transform"};
}

}  // namespace

std::span<const std::byte> Cursor::take(std::uint64_t bytes) {
  if (position_ > data_.size() || bytes > data_.size() - position_)
    throw EndsEarly{{"its data end early, so it is cut off or damaged"}};
  const auto taken = data_.subspan(position_, bytes);
  position_ += bytes;
  return taken;
}

std::string Cursor::get_string() {
  const auto length = get<std::uint32_t>();
  if (length > kLongestString) throw Damaged{"a name is " + std::to_string(length) + " bytes long"};
  const auto bytes = take(length);
  std::string text(length, '\0');
  std::memcpy(text.data(), bytes.data(), length);
  return text;
}

std::optional<std::string> meta_string(const Metadata& metadata, std::string_view name) {
  for (const MetaValue& m : metadata)
    if (m.name == name && m.type == "string") {
      std::string text(m.bytes.size(), '\0');
      std::memcpy(text.data(), m.bytes.data(), m.bytes.size());
      return text;
    }
  return std::nullopt;
}

std::optional<std::int64_t> meta_int64(const Metadata& metadata, std::string_view name) {
  return meta_value<std::int64_t>(metadata, name, "int64");
}

std::optional<VoxelIndex> meta_vec3i(const Metadata& metadata, std::string_view name) {
  const auto v = meta_value<std::array<std::int32_t, 3>>(metadata, name, "vec3i");
  if (!v) return std::nullopt;
  return VoxelIndex((*v)[0], (*v)[1], (*v)[2]);
}

FileHead read_file_head(Cursor& c) {
  if (c.get<std::int64_t>() != kMagic) throw Damaged{"it does not begin like a .vdb file"};
  FileHead head;
  head.version = c.get<std::uint32_t>();
  if (head.version < kOldest)
    throw Damaged{"its format version " + std::to_string(head.version) +
                  " dates from before OpenVDB 2 (2013); save it again with a current program"};
  if (head.version > kNewest)
    throw Damaged{"its format version " + std::to_string(head.version) + " is newer than Brume knows (" +
                  std::to_string(kNewest) + ")"};
  c.take(8);  // version of the library that wrote it
  head.has_offsets = c.get<std::uint8_t>() != 0;
  c.take(36);  // UUID as text
  read_metadata(c);
  head.grids = c.get<std::int32_t>();
  if (head.grids < 0) throw Damaged{"it announces " + std::to_string(head.grids) + " grids"};
  return head;
}

GridEntry read_grid_entry(Cursor& c) {
  GridEntry entry;
  entry.unique_name = c.get_string();
  entry.tree = c.get_string();
  entry.parent = c.get_string();
  entry.begin = c.get<std::uint64_t>();
  entry.blocks = c.get<std::uint64_t>();
  entry.end = c.get<std::uint64_t>();
  if (entry.tree.ends_with(kHalfSuffix)) {
    entry.half = true;
    entry.tree.resize(entry.tree.size() - kHalfSuffix.size());
  }
  entry.name = entry.unique_name;
  if (const auto at = entry.name.find(kSeparator); at != std::string::npos)
    entry.name = entry.name.substr(0, at) + "[" + entry.name.substr(at + 1) + "]";
  return entry;
}

GridHead read_grid_head(Cursor& c) {
  GridHead head;
  head.compression = c.get<std::uint32_t>();
  if (head.compression > (kZip | kActiveMask | kBlosc)) throw Damaged{"it has an unknown kind of compression"};
  head.metadata = read_metadata(c);
  if (const auto map = read_map(c)) head.affine = true, head.index_to_world = *map;
  return head;
}

}  // namespace brume::vdb
