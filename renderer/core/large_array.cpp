#include "renderer/core/large_array.h"

#include <sys/mman.h>

namespace brume {
namespace {

constexpr std::size_t kHugePage = std::size_t{2} << 20, kManyBytes = 2 * kHugePage;

std::align_val_t alignment_of(std::size_t bytes) { return std::align_val_t(bytes >= kManyBytes ? kHugePage : 64); }

}  // namespace

void* allocate_large(std::size_t bytes) {
  void* memory = ::operator new(bytes, alignment_of(bytes));
  if (bytes >= kManyBytes) madvise(memory, bytes / kHugePage * kHugePage, MADV_HUGEPAGE);  // a wish; may be refused
  return memory;
}

void free_large(void* memory, std::size_t bytes) noexcept { ::operator delete(memory, alignment_of(bytes)); }

}  // namespace brume
