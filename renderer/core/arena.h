// The per-thread stack pool in which a ray's temporary arrays live.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <vector>

#include "renderer/core/check.h"

namespace brume {

/// A stack of bytes: allocate, mark, rewind. One per thread; never shared.
/// When a block is full a larger one is added (addresses handed out stay valid), so an allocation never fails short
/// of the machine's memory and a march is never truncated. Kulla 2011 uses the same pool: push before a ray's volume
/// work, pop after.
class Arena {
 public:
  explicit Arena(std::size_t first_block_bytes = 16 * 1024) {
    add_block(first_block_bytes);
    use_block(0, begin(0));
  }
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  /// Uninitialised storage for `n` values, 64-byte aligned and padded to a multiple of 64 bytes, so that SIMD code may
  /// read and write whole vectors past the end. Lives until the enclosing ArenaScope ends.
  template <class T> std::span<T> alloc_span(std::size_t n) {
    static_assert(std::is_trivially_destructible_v<T> && alignof(T) <= kAlignment);
    return {reinterpret_cast<T*>(alloc_bytes(n * sizeof(T))), n};
  }

  std::size_t used_bytes() const { return used_before_ + static_cast<std::size_t>(top_ - begin(block_)); }
  std::size_t high_water_bytes() const { return std::max(high_water_, used_bytes()); }
  void reset_high_water() { high_water_ = 0; }

 private:
  friend class ArenaScope;
  static constexpr std::size_t kAlignment = 64;

  struct Block {
    std::unique_ptr<std::byte[], void (*)(std::byte*)> bytes;
    std::size_t size;
  };
  struct Mark {
    std::size_t block;
    std::byte* top;
    std::size_t used_before;
    int depth;
  };

  std::byte* begin(std::size_t block) const { return blocks_[block].bytes.get(); }

  std::byte* alloc_bytes(std::size_t n) {
    n = (n + kAlignment - 1) / kAlignment * kAlignment;
    if (static_cast<std::size_t>(end_ - top_) < n) return alloc_in_next_block(n);
    std::byte* const p = top_;
    top_ += n;
    poison(p, n);
    return p;
  }
  std::byte* alloc_in_next_block(std::size_t n);
  static void poison([[maybe_unused]] std::byte* p, [[maybe_unused]] std::size_t n) {
#ifndef NDEBUG
    std::memset(p, 0xCD, n);
#endif
  }
  void add_block(std::size_t size);
  void use_block(std::size_t block, std::byte* top) {
    block_ = block;
    top_ = top;
    end_ = begin(block) + blocks_[block].size;
  }
  void rewind(const Mark& mark) {
    BRUME_DCHECK(mark.depth, ==, depth_);
    // Since the mark the water has only risen, or another scope has ended.
    high_water_ = std::max(high_water_, used_bytes());
    if (block_ == mark.block)
      poison(mark.top, static_cast<std::size_t>(top_ - mark.top));
    else
      use_block(mark.block, mark.top);
    top_ = mark.top;
    used_before_ = mark.used_before;
    --depth_;
  }

  std::vector<Block> blocks_;
  std::size_t block_ = 0;        // the block in use
  std::byte* top_;               // where its free bytes begin
  std::byte* end_;               // and end
  std::size_t used_before_ = 0;  // bytes used in the blocks below it
  std::size_t high_water_ = 0;   // up to the last end of a scope
  int depth_ = 0;                // open scopes
};

/// Marks the arena; its end rewinds to the mark. Scopes nest and must end in reverse order.
class ArenaScope {
 public:
  explicit ArenaScope(Arena& arena)
      : arena_(arena), mark_{arena.block_, arena.top_, arena.used_before_, ++arena.depth_} {}
  ~ArenaScope() { arena_.rewind(mark_); }
  ArenaScope(const ArenaScope&) = delete;
  ArenaScope& operator=(const ArenaScope&) = delete;

 private:
  Arena& arena_;
  Arena::Mark mark_;
};

}  // namespace brume
