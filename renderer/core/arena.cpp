#include "renderer/core/arena.h"

#include <algorithm>

namespace brume {
namespace {

#ifndef NDEBUG
constexpr int kPoison = 0xCD;
#endif

std::size_t round_up(std::size_t n, std::size_t alignment) { return (n + alignment - 1) / alignment * alignment; }

}  // namespace

void Arena::add_block(std::size_t size) {
  size = round_up(std::max<std::size_t>(size, kAlignment), kAlignment);
  auto* bytes = static_cast<std::byte*>(::operator new(size, std::align_val_t(kAlignment)));
  blocks_.push_back({{bytes, [](std::byte* p) { ::operator delete(p, std::align_val_t(kAlignment)); }}, size});
}

std::byte* Arena::alloc_bytes(std::size_t n) {
  n = round_up(n, kAlignment);
  while (blocks_[block_].size - top_ < n) {
    if (block_ + 1 == blocks_.size()) add_block(std::max(n, 2 * blocks_[block_].size));
    used_before_ += top_;
    top_ = 0;
    ++block_;
  }
  std::byte* p = blocks_[block_].bytes.get() + top_;
  top_ += n;
  high_water_ = std::max(high_water_, used_bytes());
#ifndef NDEBUG
  std::memset(p, kPoison, n);
#endif
  return p;
}

void Arena::rewind(const Mark& mark) {
  BRUME_DCHECK(mark.depth, ==, depth_);
#ifndef NDEBUG
  if (block_ == mark.block) std::memset(blocks_[block_].bytes.get() + mark.top, kPoison, top_ - mark.top);
#endif
  block_ = mark.block;
  top_ = mark.top;
  used_before_ = mark.used_before;
  --depth_;
}

}  // namespace brume
