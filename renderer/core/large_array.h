// Arrays of many megabytes, filled right after they were made.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace brume {

/// Memory for `bytes`, 64-byte aligned; where there is much of it, asked for in huge pages, because touching it for the
/// first time costs a fault for each page. Throws std::bad_alloc.
void* allocate_large(std::size_t bytes);
void free_large(void* memory, std::size_t bytes) noexcept;

/// Allocates so, and leaves new elements as their constructor does instead of writing zeros.
template <class T> struct LargeArrayAllocator {
  using value_type = T;
  LargeArrayAllocator() = default;
  template <class U> LargeArrayAllocator(const LargeArrayAllocator<U>&) {}

  T* allocate(std::size_t n) { return static_cast<T*>(allocate_large(n * sizeof(T))); }
  void deallocate(T* p, std::size_t n) noexcept { free_large(p, n * sizeof(T)); }
  template <class U> void construct(U* p) noexcept { ::new (static_cast<void*>(p)) U; }
  template <class U, class... Arguments> void construct(U* p, Arguments&&... arguments) {
    ::new (static_cast<void*>(p)) U(std::forward<Arguments>(arguments)...);
  }
  bool operator==(const LargeArrayAllocator&) const { return true; }
};

template <class T> using LargeArray = std::vector<T, LargeArrayAllocator<T>>;

}  // namespace brume
