#include "renderer/media/vdb_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "renderer/media/grid_file.h"

namespace brume::vdb {
namespace {

/// Bits of a node: bit n is bit n % 64 of word n / 64.
template <int kLog2> struct NodeMask {
  static constexpr int kBits = 1 << (3 * kLog2);
  std::array<std::uint64_t, kBits / 64> words;

  bool on(int n) const { return words[static_cast<unsigned>(n) / 64] >> (n % 64) & 1; }
  int count() const {
    int n = 0;
    for (const std::uint64_t w : words) n += std::popcount(w);
    return n;
  }
  template <class F> void for_each_on(const F& f) const {
    for (int i = 0; i < kBits / 64; ++i)
      for (std::uint64_t w = words[static_cast<unsigned>(i)]; w; w &= w - 1) f(i * 64 + std::countr_zero(w));
  }
};
using LeafMask = NodeMask<3>;

/// Origin of child or voxel n of a node whose children have 2^child_log2 voxels an edge.
template <int kLog2> VoxelIndex place(VoxelIndex origin, int n, int child_log2) {
  constexpr int kLow = (1 << kLog2) - 1;
  return origin +
         VoxelIndex((n >> (2 * kLog2)) << child_log2, (n >> kLog2 & kLow) << child_log2, (n & kLow) << child_log2);
}

/// IEEE 754 binary16 to binary32, exact.
float from_half(std::uint16_t half) {
  const std::uint32_t sign = (half & 0x8000u) << 16, exponent = half >> 10 & 31, fraction = half & 0x3FFu;
  if (exponent == 0) {
    const float subnormal = static_cast<float>(fraction) * 0x1p-24f;
    return sign ? -subnormal : subnormal;
  }
  const std::uint32_t wide = exponent == 31 ? 255 : exponent + (127 - 15);
  return std::bit_cast<float>(sign | wide << 23 | fraction << 13);
}

struct ValueLayout {
  std::string_view name;
  Value value;
  unsigned bytes, half_bytes;  // half_bytes: per value where 16-bit storage is on
};
constexpr ValueLayout kValues[] = {
    {"float", Value::Float, 4, 2},  {"double", Value::Double, 8, 2}, {"int32", Value::Int32, 4, 4},
    {"int64", Value::Int64, 8, 8},  {"bool", Value::Bool, 1, 1},     {"mask", Value::Mask, 1, 1},
    {"vec3s", Value::Vec3s, 12, 6}, {"vec3d", Value::Vec3d, 24, 6},  {"vec3i", Value::Vec3i, 12, 12},
};
const ValueLayout& layout(Value value) {
  return *std::find_if(std::begin(kValues), std::end(kValues),
                       [value](const ValueLayout& l) { return l.value == value; });
}

/// Vectors count as 0: they are walked over, never used.
float to_float(Value value, const std::byte* p) {
  const auto as = [p]<class T>(T v) { return std::memcpy(&v, p, sizeof v), static_cast<float>(v); };
  switch (value) {
    case Value::Float:
      return as(0.0f);
    case Value::Double:
      return as(0.0);
    case Value::Int32:
      return as(std::int32_t{});
    case Value::Int64:
      return as(std::int64_t{});
    case Value::Bool:
    case Value::Mask:
      return *p != std::byte{0} ? 1.0f : 0.0f;
    default:
      return 0;
  }
}

float negated(Value value, float v) { return value == Value::Bool || value == Value::Mask ? 1 - v : -v; }

/// How a node's inactive values are kept (openvdb/io/Compression.h).
enum NodeCode : std::int8_t {
  kBackground = 0,
  kMinusBackground,
  kOneValue,
  kSelectMinusOrPlus,
  kSelectOneOrBackground,
  kSelectTwo,
  kAllValues
};

/// The values of one node, found but not decoded.
template <int kLog2> struct NodeValues {
  float inactive[2] = {};  // which one is told by `select`
  std::optional<NodeMask<kLog2>> select;
  int stored = 0;                    // values in the chunk: all of them, or the active ones
  std::span<const std::byte> chunk;  // compressed: with its 8-byte length
  bool compressed = false;
};

template <int kLog2>
NodeValues<kLog2> find_values(Cursor& c, const TreeFormat& format, const NodeMask<kLog2>& active, float background) {
  using Mask = NodeMask<kLog2>;
  const ValueLayout& value = layout(format.value);
  NodeValues<kLog2> found;
  const auto code = c.get<std::int8_t>();
  if (code < kBackground || code > kAllValues) throw Damaged{"a block has an unknown kind of compression"};
  found.inactive[0] = code == kBackground ? background : negated(format.value, background);
  found.inactive[1] = background;
  if (code == kOneValue || code == kSelectOneOrBackground || code == kSelectTwo)
    found.inactive[0] = to_float(format.value, c.take(value.bytes).data());
  if (code == kSelectTwo) found.inactive[1] = to_float(format.value, c.take(value.bytes).data());
  if (code == kSelectMinusOrPlus || code == kSelectOneOrBackground || code == kSelectTwo) found.select = c.get<Mask>();

  const bool only_active = (format.compression & kActiveMask) && code != kAllValues;
  found.stored = only_active ? active.count() : Mask::kBits;
  const bool half = format.half && value.half_bytes != value.bytes;
  const std::uint64_t bytes = static_cast<std::uint64_t>(found.stored) * (half ? value.half_bytes : value.bytes);
  if (half && found.stored == 0) return found;
  if (!(format.compression & (kZip | kBlosc))) {
    found.chunk = c.take(bytes);
    return found;
  }
  Cursor at_length = c;
  const auto length = c.get<std::int64_t>();
  if (length > 0) {
    c.take(static_cast<std::uint64_t>(length));
    found.chunk = at_length.take(8 + static_cast<std::uint64_t>(length));
    found.compressed = true;
  } else {  // a negative length: stored as it is, for it would not shrink
    if (bytes != 0 - static_cast<std::uint64_t>(length)) throw Damaged{"a block of values has the wrong size"};
    found.chunk = c.take(bytes);
  }
  return found;
}

/// Writes all values of the node; those at the places of children are meaningless. `out` has kBits elements.
template <int kLog2>
void decode(const NodeValues<kLog2>& found, const TreeFormat& format, const NodeMask<kLog2>& active, float* out) {
  constexpr int kBits = NodeMask<kLog2>::kBits;
  const ValueLayout& value = layout(format.value);
  const bool half = format.half && value.half_bytes != value.bytes;
  const unsigned size = half ? value.half_bytes : value.bytes;
  const std::size_t bytes = static_cast<std::size_t>(found.stored) * size;

  std::vector<std::byte> unpacked;
  const std::byte* raw = found.chunk.data();
  if (found.compressed && bytes > 0) {
    unpacked.resize(bytes);
    if (!decompress((format.compression & kBlosc) != 0, found.chunk, unpacked))
      throw Damaged{"a block of values cannot be decompressed"};
    raw = unpacked.data();
  }
  const auto value_at = [&](int i) {
    const std::byte* p = raw + static_cast<std::size_t>(i) * size;
    if (!half) return to_float(format.value, p);
    std::uint16_t bits;
    std::memcpy(&bits, p, sizeof bits);
    return from_half(bits);
  };
  int next = 0;
  for (int n = 0; n < kBits; ++n) {
    if (found.stored == kBits || active.on(n))
      out[n] = value_at(next++);
    else
      out[n] = found.inactive[found.select && found.select->on(n) ? 1 : 0];
  }
}

/// Reads the nodes below the root in the order of the file.
class TopologyReader {
 public:
  TopologyReader(Cursor& c, const TreeFormat& format, Tree& tree) : c_(c), format_(format), tree_(tree) {}

  void root() {
    const unsigned bytes = layout(format_.value).bytes;
    if (c_.get<std::int32_t>() != 1) throw Damaged{"the tree has more than one value a voxel"};
    tree_.background = to_float(format_.value, c_.take(bytes).data());
    const auto tiles = c_.get<std::uint32_t>(), children = c_.get<std::uint32_t>();
    // OpenVDB keeps both sorted, and later finds the leaves' values in that order.
    std::optional<VoxelIndex> last;
    for (std::uint32_t i = 0; i < tiles; ++i) {
      const VoxelIndex origin = root_place(last);
      const float value = to_float(format_.value, c_.take(bytes).data());
      add_tile(origin, 4096, value, c_.get<std::uint8_t>() != 0);
    }
    last.reset();
    for (std::uint32_t i = 0; i < children; ++i) node<5, 7>(root_place(last));
  }

 private:
  static bool before(VoxelIndex a, VoxelIndex b) { return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z; }

  /// A place in the root, which must lie behind `last`; replaces that.
  VoxelIndex root_place(std::optional<VoxelIndex>& last) {
    const auto x = c_.get<std::int32_t>(), y = c_.get<std::int32_t>(), z = c_.get<std::int32_t>();
    if ((x | y | z) & 4095) throw Damaged{"the tree has a branch at an impossible place"};
    if (last && !before(*last, {x, y, z})) throw Damaged{"the tree's branches are out of order"};
    last = VoxelIndex(x, y, z);
    return *last;
  }

  /// An internal node with 2^kLog2 children an edge, each of 2^kChildLog2 voxels an edge.
  template <int kLog2, int kChildLog2> void node(VoxelIndex origin) {
    using Mask = NodeMask<kLog2>;
    const auto children = c_.get<Mask>(), active = c_.get<Mask>();
    const NodeValues<kLog2> found = find_values(c_, format_, active, tree_.background);
    // The usual case needs no decoding: no active tile, and every inactive value is the background.
    const bool plain = !found.select && same_value(found.inactive[0], tree_.background) && found.stored == 0;
    if (!plain) {
      std::vector<float> values(Mask::kBits);
      decode(found, format_, active, values.data());
      for (int n = 0; n < Mask::kBits; ++n)
        if (!children.on(n))
          add_tile(place<kLog2>(origin, n, kChildLog2), 1 << kChildLog2, values[static_cast<unsigned>(n)],
                   active.on(n));
    }
    children.for_each_on([&](int n) {
      const VoxelIndex child = place<kLog2>(origin, n, kChildLog2);
      if constexpr (kLog2 == 5)
        node<4, 3>(child);
      else
        leaf(child);
    });
  }

  void leaf(VoxelIndex origin) {
    const auto active = c_.get<LeafMask>();
    tree_.leaves.push_back({origin});
    int low[3] = {8, 8, 8}, high[3] = {-1, -1, -1};
    active.for_each_on([&](int n) {
      const int local[3] = {n >> 6, n >> 3 & 7, n & 7};
      for (int axis = 0; axis < 3; ++axis)
        low[axis] = std::min(low[axis], local[axis]), high[axis] = std::max(high[axis], local[axis]);
    });
    if (high[0] >= 0)
      add_active(origin + VoxelIndex(low[0], low[1], low[2]), origin + VoxelIndex(high[0], high[1], high[2]),
                 static_cast<std::uint64_t>(active.count()));
  }

  void add_tile(VoxelIndex origin, int size, float value, bool active) {
    const auto edge = static_cast<std::uint64_t>(size);
    if (active) add_active(origin, origin + VoxelIndex(size - 1), edge * edge * edge);
    if (active || !same_value(value, tree_.background)) tree_.tiles.push_back({origin, size, value, active});
  }

  void add_active(VoxelIndex low, VoxelIndex high, std::uint64_t count) {
    const bool first = tree_.active_voxels == 0;
    tree_.active_min = first ? low : min(tree_.active_min, low);
    tree_.active_max = first ? high : max(tree_.active_max, high);
    tree_.active_voxels += count;
  }

  Cursor& c_;
  const TreeFormat& format_;
  Tree& tree_;
};

}  // namespace

std::optional<Value> value_of_tree(std::string_view tree) {
  for (const ValueLayout& l : kValues)
    if (tree == "Tree_" + std::string(l.name) + "_5_4_3") return l.value;
  return std::nullopt;
}

bool is_scalar(Value value) { return value != Value::Vec3s && value != Value::Vec3d && value != Value::Vec3i; }

Tree read_topology(Cursor& c, const TreeFormat& format) {
  Tree tree;
  TopologyReader(c, format, tree).root();
  return tree;
}

void find_leaf_values(Cursor& c, const TreeFormat& format, Tree& tree) {
  for (LeafPlace& leaf : tree.leaves) {
    leaf.begin = c.position();
    const auto active = c.get<LeafMask>();
    if (format.value == Value::Bool)
      c.take(12 + 64);  // origin, values as bits
    else if (format.value == Value::Mask)
      c.take(12);
    else
      find_values(c, format, active, tree.background);
  }
}

void read_leaf(std::span<const std::byte> data, const TreeFormat& format, const Tree& tree, const LeafPlace& place,
               LeafBlock& leaf) {
  Cursor c(data, place.begin);
  const auto active = c.get<LeafMask>();
  leaf.origin = place.origin;
  leaf.active = active.words;
  if (format.value == Value::Bool || format.value == Value::Mask) {
    LeafMask values = active;
    if (format.value == Value::Bool) c.take(12), values = c.get<LeafMask>();
    for (int n = 0; n < LeafBlock::kVoxels; ++n) leaf.values[static_cast<unsigned>(n)] = values.on(n) ? 1.0f : 0.0f;
    return;
  }
  decode(find_values(c, format, active, tree.background), format, active, leaf.values.data());
}

}  // namespace brume::vdb
