#include "renderer/media/brick_grid.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <unordered_map>

#include "renderer/core/check.h"
#include "renderer/core/parallel.h"

namespace brume {
namespace {

constexpr int kLeaf = LeafBlock::kSize;
constexpr int kVoxels = LeafBlock::kVoxels;
static_assert(kLeaf == BrickGrid::kCells, "a brick's cells start at the voxels of one leaf");

using Index64 = Vec3T<std::int64_t>;

std::int64_t floor_to_brick(std::int64_t i) { return i >> 3; }  // arithmetic shift: rounds down for negatives too

/// Box of voxels, inclusive; empty as constructed.
struct VoxelBox {
  Index64 low{std::numeric_limits<std::int64_t>::max()}, high{std::numeric_limits<std::int64_t>::min()};

  bool empty() const { return low.x > high.x; }
  void add(Index64 a, Index64 b) { low = min(low, a), high = max(high, b); }
  bool contains(Index64 a, Index64 b) const { return min(low, a) == low && max(high, b) == high; }
  bool overlaps(Index64 a, Index64 b) const {
    const Index64 from = max(low, a), to = min(high, b);
    return from.x <= to.x && from.y <= to.y && from.z <= to.z;
  }
};

/// Widens `box` by the active voxels of the leaf; returns how many there are.
int add_active(const LeafBlock& leaf, VoxelBox& box) {
  std::uint64_t all = 0;
  int count = 0, x_low = kLeaf, x_high = -1;
  for (int x = 0; x < kLeaf; ++x) {  // word x holds the slab of voxels (x, *, *)
    const std::uint64_t slab = leaf.active[static_cast<unsigned>(x)];
    if (!slab) continue;
    all |= slab;
    count += std::popcount(slab);
    x_low = std::min(x_low, x), x_high = x;
  }
  if (!all) return 0;
  std::uint64_t z_bits = 0;
  for (int y = 0; y < kLeaf; ++y) z_bits |= all >> (8 * y) & 0xFF;
  const int y_low = std::countr_zero(all) / 8, y_high = (63 - std::countl_zero(all)) / 8;
  const int z_low = std::countr_zero(z_bits), z_high = 63 - std::countl_zero(z_bits);
  const Index64 origin(leaf.origin);
  box.add(origin + Index64(x_low, y_low, z_low), origin + Index64(x_high, y_high, z_high));
  return count;
}

/// What the table pass needs to know of a leaf after its values were mended.
struct LeafSummary {
  bool constant = false;  // all 512 values are equal
  /// Bit d is set when a voxel that is not 0 exists among those with coordinate 0 along every axis in d
  /// (4: x, 2: y, 1: z). Those voxels are the ones that the brick before this one along these axes stores too.
  std::uint8_t filled = 0;
  float low = std::numeric_limits<float>::infinity();  // of the active voxels
  float high = 0;                                      // of all voxels
  int non_finite = 0, negative = 0;
};

/// Mends the values of the leaf in place: bad ones and those outside `box` become 0.
LeafSummary mend_and_summarise(LeafBlock& leaf, const VoxelBox& box) {
  LeafSummary s;
  const Index64 origin(leaf.origin);
  if (!box.contains(origin, origin + Index64(kLeaf - 1))) {
    for (int e = 0; e < kVoxels; ++e) {
      const Index64 at = origin + Index64(e >> 6, e >> 3 & 7, e & 7);
      if (!box.contains(at, at)) leaf.values[static_cast<unsigned>(e)] = 0;
    }
  }
  for (float& v : leaf.values) {
    const bool finite = std::isfinite(v), negative = finite && v < 0;
    s.non_finite += !finite;
    s.negative += negative;
    v = finite && v > 0 ? v : 0.0f;  // without the sign of -0, which half floats are looked up without
    s.high = std::max(s.high, v);
  }
  s.constant = true;
  for (int e = 0; e < kVoxels; ++e) {
    const float v = leaf.values[static_cast<unsigned>(e)];
    s.constant &= v == leaf.values[0];
    if (leaf.is_active(e)) s.low = std::min(s.low, v);
  }
  for (int x = 0; x < kLeaf; ++x)
    for (int y = 0; y < kLeaf; ++y) {
      const float* row = &leaf.values[static_cast<unsigned>((x * kLeaf + y) * kLeaf)];
      bool row_filled = false;
      for (int z = 0; z < kLeaf; ++z) row_filled |= row[z] != 0;
      const unsigned in_row = (row_filled ? 1u : 0u) | (row[0] != 0 ? 2u : 0u);  // bits d = 0 (all z) and d = 1 (z = 0)
      s.filled = static_cast<std::uint8_t>(s.filled | in_row | (y == 0 ? in_row << 2 : 0u) |
                                           (x == 0 ? in_row << 4 : 0u) | (x == 0 && y == 0 ? in_row << 6 : 0u));
    }
  return s;
}

struct TilesOverlap {};

}  // namespace

/// Builds one BrickGrid. The table is filled with what lies in each 8^3 block ("content"), then turned in place into
/// brick numbers, noting for every brick that needs storage the eight contents it is put together from, and at last
/// into the places of the bricks' values.
class BrickBuilder {
 public:
  BrickBuilder(VoxelBlocks blocks, const LoadOptions& options) : blocks_(std::move(blocks)), options_(options) {}

  Result<BrickGrid> build() {
    if (auto sized = find_extent(); !sized) return sized.error();
    if (!mend_leaves()) return loading_cancelled();
    fill_table();
    number_bricks();
    if (options_.cancel.stop_requested()) return loading_cancelled();
    if (auto enough = check_memory(blocks_.leaves.size() * sizeof(LeafBlock) + grid_.table_.size() * 4 + value_bytes());
        !enough)
      return enough.error();
    if (auto enough = place_bricks(); !enough) return enough.error();
    if (!fill_values()) return loading_cancelled();
    return std::move(grid_);
  }

 private:
  /// Content of a place: 0 nothing, i+1 leaf i, -(k+1) all voxels have the value constants_[k].
  using Content = std::int32_t;
  Content* contents() { return reinterpret_cast<Content*>(grid_.table_.data()); }  // before it holds what it is for
  struct Stored {
    Content parts[8];  // part d: the block that lies one further along the axes in d (4: x, 2: y, 1: z)
  };

  Result<void> find_extent() {
    VoxelBox& box = active_;
    for (const LeafBlock& leaf : blocks_.leaves)
      grid_.active_voxels_ += static_cast<std::uint64_t>(add_active(leaf, box));
    for (const TileBlock& tile : blocks_.tiles) {
      if (!tile.active) continue;
      const auto size = static_cast<std::uint64_t>(tile.size);
      grid_.active_voxels_ += size * size * size;
      box.add(Index64(tile.origin), Index64(tile.origin) + Index64(tile.size - 1));
    }
    if (box.empty()) return bad_input("the grid is empty: it has no active voxel");

    // Cell min-1 still touches voxel min, so the table starts one cell early.
    for (int axis = 0; axis < 3; ++axis) {
      first_[axis] = floor_to_brick(box.low[axis] - 1);
      extent_[axis] = floor_to_brick(box.high[axis]) - first_[axis] + 1;
    }
    const std::int64_t longest = std::max({extent_.x, extent_.y, extent_.z}) * kLeaf;
    const std::int64_t limit = BrickGrid::kMaxTableEntries;
    // The first test keeps the products of the second within 63 bits.
    if (longest > BrickGrid::kMaxExtent || extent_.x * extent_.y > limit || extent_.x * extent_.y * extent_.z > limit)
      return bad_input("the active voxels span " + std::to_string(extent_.x * kLeaf) + " x " +
                       std::to_string(extent_.y * kLeaf) + " x " + std::to_string(extent_.z * kLeaf) +
                       " voxels, more than Brume can index (" + std::to_string(limit) + " blocks of 8^3 voxels, " +
                       std::to_string(BrickGrid::kMaxExtent) +
                       " voxels along an axis); crop the grid or remove stray voxels");
    const Index64 origin = first_ * std::int64_t{kLeaf};
    if (std::min({origin.x, origin.y, origin.z}) < std::numeric_limits<int>::min())
      return bad_input("the active voxels reach the lowest possible index; move the grid towards its origin");
    grid_.table_origin_ = VoxelIndex(origin);
    grid_.table_extent_ = VoxelIndex(extent_);
    grid_.active_min_ = VoxelIndex(box.low);
    grid_.active_max_ = VoxelIndex(box.high);
    return {};
  }

  /// Mends every value, and cuts inactive tiles at the active box by turning the bricks on its faces into leaves.
  bool mend_leaves() {
    std::vector<TileBlock> tiles;
    for (TileBlock tile : blocks_.tiles) {
      const Index64 low(tile.origin), high = low + Index64(tile.size - 1);
      if (!active_.overlaps(low, high)) continue;
      const bool finite = std::isfinite(tile.value);
      if (!finite || tile.value < 0) {
        const auto size = static_cast<std::uint64_t>(tile.size);
        (finite ? grid_.negative_voxels_ : grid_.non_finite_voxels_) += size * size * size;
        tile.value = 0;
      }
      if (tile.active) low_ = std::min(low_, tile.value);
      if (tile.active || active_.contains(low, high))
        tiles.push_back(tile);
      else if (tile.value != 0)
        split(tile, tiles);
    }
    blocks_.tiles = std::move(tiles);

    summaries_.resize(blocks_.leaves.size());
    const auto leaves = static_cast<std::int64_t>(blocks_.leaves.size());
    const bool finished = parallel_load(leaves, options_, 0.0f, 0.4f, [&](std::int64_t i) {
      summaries_[static_cast<std::size_t>(i)] =
          mend_and_summarise(blocks_.leaves[static_cast<std::size_t>(i)], active_);
    });
    if (!finished) return false;
    for (const LeafSummary& s : summaries_) {
      low_ = std::min(low_, s.low);
      grid_.max_value_ = std::max(grid_.max_value_, s.high);
      grid_.non_finite_voxels_ += static_cast<std::uint64_t>(s.non_finite);
      grid_.negative_voxels_ += static_cast<std::uint64_t>(s.negative);
    }
    for (const TileBlock& tile : blocks_.tiles) grid_.max_value_ = std::max(grid_.max_value_, tile.value);
    grid_.min_value_ = std::min(low_, grid_.max_value_);
    return true;
  }

  void split(const TileBlock& tile, std::vector<TileBlock>& tiles) {
    for_bricks(tile, [&](Index64 place, std::size_t) {
      const Index64 low = place * std::int64_t{kLeaf};
      if (!active_.overlaps(low, low + Index64(kLeaf - 1))) return;
      if (active_.contains(low, low + Index64(kLeaf - 1))) {
        tiles.push_back({VoxelIndex(low), kLeaf, tile.value, false});
        return;
      }
      const std::size_t leaves = blocks_.leaves.size();
      if (leaves % 1024 == 0 && !check_memory(2 * leaves * sizeof(LeafBlock))) throw std::bad_alloc();
      LeafBlock& leaf = blocks_.leaves.emplace_back();
      leaf.origin = VoxelIndex(low);
      leaf.active.fill(0);
      leaf.values.fill(tile.value);
    });
  }

  /// Calls f(place in bricks, table entry) for the part of the tile that lies in the table. Throws TilesOverlap.
  template <class F> void for_bricks(const TileBlock& tile, const F& f) {
    const Index64 low = Index64(tile.origin), last = low + Index64(tile.size - 1);
    Index64 from, to;
    for (int axis = 0; axis < 3; ++axis) {
      from[axis] = std::max(floor_to_brick(low[axis]), first_[axis]);
      to[axis] = std::min(floor_to_brick(last[axis]), first_[axis] + extent_[axis] - 1);
    }
    if (to.x < from.x || to.y < from.y || to.z < from.z) return;
    // Each place is visited once when tiles are split and once when the table is filled, unless a damaged file has
    // tiles one upon the other, thousands of them perhaps.
    visited_ += (to.x - from.x + 1) * (to.y - from.y + 1) * (to.z - from.z + 1);
    if (visited_ > 3 * extent_.x * extent_.y * extent_.z) throw TilesOverlap();
    for (std::int64_t x = from.x; x <= to.x; ++x)
      for (std::int64_t y = from.y; y <= to.y; ++y)
        for (std::int64_t z = from.z; z <= to.z; ++z) f(Index64(x, y, z), *element({x, y, z}));
  }

  /// Table entry of a place in bricks, if it lies in the table.
  std::optional<std::size_t> element(Index64 place) const {
    const Index64 p = place - first_;
    for (int axis = 0; axis < 3; ++axis)
      if (p[axis] < 0 || p[axis] >= extent_[axis]) return std::nullopt;
    return static_cast<std::size_t>(1 + (p.x * extent_.y + p.y) * extent_.z + p.z);
  }

  Content constant(float value) {
    if (value == 0) return 0;
    const auto [entry, is_new] = constant_of_value_.try_emplace(value, static_cast<Content>(constants_.size()));
    if (is_new) constants_.push_back(value);
    return -1 - entry->second;
  }

  void fill_table() {
    grid_.table_.assign(static_cast<std::size_t>(1 + extent_.x * extent_.y * extent_.z), 0);
    for (const TileBlock& tile : blocks_.tiles) {
      const Content content = constant(tile.value);
      for_bricks(tile, [&](Index64, std::size_t at) { contents()[at] = content; });
    }
    for (std::size_t i = 0; i < blocks_.leaves.size(); ++i) {
      const LeafBlock& leaf = blocks_.leaves[i];
      const VoxelIndex o = leaf.origin;
      const auto at = element({floor_to_brick(o.x), floor_to_brick(o.y), floor_to_brick(o.z)});
      if (!at) continue;  // a leaf without active voxels, outside the active box
      contents()[*at] = summaries_[i].constant ? constant(leaf.values[0]) : static_cast<Content>(i + 1);
    }
  }

  bool part_filled(Content content, int d) const {
    return content < 0 || (content > 0 && (summaries_[static_cast<std::size_t>(content - 1)].filled >> d & 1));
  }

  /// Replaces contents by brick numbers. A brick needs the contents at and after its own place only, and places are
  /// visited in rising order, so this works in place.
  void number_bricks() {
    std::unordered_map<Content, std::int32_t> brick_of_constant;
    const std::vector<Content> beyond(static_cast<std::size_t>(extent_.z), 0);  // the row outside the table
    std::vector<Content> any(static_cast<std::size_t>(extent_.z + 1), 0);  // bits of all contents at z in four rows
    const auto row_at = [&](std::int64_t x, std::int64_t y) {
      if (x == extent_.x || y == extent_.y) return beyond.data();
      return static_cast<const Content*>(contents()) + 1 + (x * extent_.y + y) * extent_.z;
    };
    Content* row = contents() + 1;
    for (std::int64_t x = 0; x < extent_.x; ++x)
      for (std::int64_t y = 0; y < extent_.y; ++y, row += extent_.z) {
        if (options_.cancel.stop_requested()) return;
        const Content* rows[4] = {row, row_at(x, y + 1), row_at(x + 1, y), row_at(x + 1, y + 1)};
        // Tables are mostly empty; this loop is a vector loop, and the next one skips.
        for (std::int64_t z = 0; z < extent_.z; ++z)
          any[static_cast<std::size_t>(z)] = rows[0][z] | rows[1][z] | rows[2][z] | rows[3][z];
        for (std::int64_t z = 0; z < extent_.z; ++z) {
          if ((any[static_cast<std::size_t>(z)] | any[static_cast<std::size_t>(z + 1)]) == 0) continue;
          Stored stored;
          for (int d = 0; d < 8; ++d) stored.parts[d] = z + (d & 1) < extent_.z ? rows[d >> 1][z + (d & 1)] : 0;
          row[z] = number(stored, brick_of_constant);
        }
      }
  }

  /// The brick that is put together from these contents: 0, one that exists already, or a new one.
  std::int32_t number(const Stored& stored, std::unordered_map<Content, std::int32_t>& brick_of_constant) {
    bool filled = false, same = true;
    for (int d = 0; d < 8; ++d) {
      filled |= part_filled(stored.parts[d], d);
      same &= stored.parts[d] == stored.parts[0];
    }
    if (!filled) return 0;
    const auto next = static_cast<std::int32_t>(stored_.size() + 1);
    if (same && stored.parts[0] < 0) {
      const auto [entry, is_new] = brick_of_constant.try_emplace(stored.parts[0], next);
      if (!is_new) return entry->second;
    }
    stored_.push_back(stored);
    return next;
  }

  Result<void> place_bricks() {
    const std::size_t elements = elements_per_brick(layout()), most = (std::size_t{1} << 32) / elements;
    if (stored_.size() >= most)
      return bad_input("the grid needs " + std::to_string(stored_.size() + 1) + " bricks of 8^3 voxels, expected " +
                       std::to_string(most) + " at most; crop it or halve its resolution");
    for (std::uint32_t& entry : grid_.table_) entry *= static_cast<std::uint32_t>(elements);
    return {};
  }

  std::uint64_t value_bytes() const { return (stored_.size() + 1) * bytes_per_brick(layout()); }

  BrickLayout layout() const {
    if (options_.full_precision || grid_.max_value_ > BrickValues::kLargestInHalves) return BrickLayout::Full;
    // Large caches are shared with others: what a virtual machine is told is often that of its whole host.
    const std::size_t ours = std::min(last_cache_bytes(), std::size_t{32} << 20);
    const std::size_t quads = (stored_.size() + 1) * bytes_per_brick(BrickLayout::Quad);
    return quads <= ours ? BrickLayout::Quad : BrickLayout::Half;
  }

  bool fill_values() {
    grid_.brick_count_ = static_cast<int>(stored_.size() + 1);
    grid_.values_ = BrickValues(layout(), stored_.size() + 1, grid_.max_value_);
    grid_.brick_max_.resize(stored_.size() + 1);
    return parallel_load(static_cast<std::int64_t>(stored_.size()), options_, 0.4f, 1.0f, [&](std::int64_t i) {
      const auto brick = static_cast<std::size_t>(i);
      float voxels[BrickValues::kVoxels];
      assemble(stored_[brick], voxels);
      grid_.brick_max_[brick + 1] = grid_.values_.store(brick + 1, voxels);
    });
  }

  /// Puts the 9^3 voxels together: rows along z, eight voxels from one block and the ninth from the next.
  void assemble(const Stored& stored, float* voxels) const {
    float* row = voxels;
    for (int x = 0; x <= kLeaf; ++x)
      for (int y = 0; y <= kLeaf; ++y, row += BrickValues::kCorners) {
        const int d = (x == kLeaf ? 4 : 0) | (y == kLeaf ? 2 : 0);
        const int first = ((x & 7) * kLeaf + (y & 7)) * kLeaf;  // & 7: the ninth voxel is the first of the next block
        copy(stored.parts[d], first, kLeaf, row);
        copy(stored.parts[d | 1], first, 1, row + kLeaf);
      }
  }

  void copy(Content content, int first, int n, float* to) const {
    if (content > 0)
      std::copy_n(&blocks_.leaves[static_cast<std::size_t>(content - 1)].values[static_cast<unsigned>(first)], n, to);
    else
      std::fill_n(to, n, content == 0 ? 0.0f : constants_[static_cast<std::size_t>(-1 - content)]);
  }

  VoxelBlocks blocks_;
  const LoadOptions& options_;
  BrickGrid grid_;
  VoxelBox active_;
  Index64 first_, extent_;  // of the table, in bricks
  std::int64_t visited_ = 0;
  float low_ = std::numeric_limits<float>::infinity();
  std::vector<LeafSummary> summaries_;
  std::vector<float> constants_;
  std::unordered_map<float, Content> constant_of_value_;
  std::vector<Stored> stored_;
};

Result<BrickGrid> build_brick_grid(VoxelBlocks blocks, const LoadOptions& options) {
  try {
    return BrickBuilder(std::move(blocks), options).build();
  } catch (const std::bad_alloc&) {
    return bad_input("the grid does not fit in the free memory; crop it or halve its resolution");
  } catch (const TilesOverlap&) {
    return bad_input("the grid is damaged: its tiles overlap");
  } catch (const std::length_error&) {
    return bad_input("the grid does not fit in the free memory; crop it or halve its resolution");
  }
}

}  // namespace brume
