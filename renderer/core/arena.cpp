#include "renderer/core/arena.h"

#include <algorithm>

namespace brume {
namespace {

std::size_t round_up(std::size_t n, std::size_t alignment) { return (n + alignment - 1) / alignment * alignment; }

}  // namespace

void Arena::add_block(std::size_t size) {
  size = round_up(std::max<std::size_t>(size, kAlignment), kAlignment);
  auto* bytes = static_cast<std::byte*>(::operator new(size, std::align_val_t(kAlignment)));
  blocks_.push_back({{bytes, [](std::byte* p) { ::operator delete(p, std::align_val_t(kAlignment)); }}, size});
}

std::byte* Arena::alloc_in_next_block(std::size_t n) {
  while (static_cast<std::size_t>(end_ - top_) < n) {
    if (block_ + 1 == blocks_.size()) add_block(std::max(n, 2 * blocks_[block_].size));
    used_before_ += static_cast<std::size_t>(top_ - begin(block_));
    use_block(block_ + 1, begin(block_ + 1));
  }
  return alloc_bytes(n);
}

}  // namespace brume
