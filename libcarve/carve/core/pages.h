#pragma once
#include <cstddef>
#include <new>
#include <utility>
#include <vector>

namespace carve {

/// Memory for large blocks that are written once and soon given back: their cost is the system's, which hands out and
/// clears small pages one by one. Blocks of a megabyte and more lie on huge pages where the system has them; the last
/// ones given back are kept, at most kKeptBytes in all, for a later block of the same size.
inline constexpr std::size_t kKeptBytes = std::size_t{256} << 20;
void* take_pages(std::size_t bytes);
void give_pages(void* block, std::size_t bytes) noexcept;

/// Asks the system for huge pages under memory that has been reserved but not touched.
void prefer_huge_pages(void* data, std::size_t bytes);

/// For programs, at their start: small and middling blocks (to 32 MB) that are given back are kept for the next ones,
/// to 256 MB, by the C library too. Without it smoothing a large mesh takes twice as long: most of that is fresh pages.
void keep_freed_memory();

/// vector.resize(count) for a large empty vector, on huge pages where the system has them.
template <class T>
void resize_on_huge_pages(std::vector<T>& vector, std::size_t count) {
  vector.reserve(count);
  prefer_huge_pages(vector.data(), count * sizeof(T));
  vector.resize(count);
}

/// For vectors of numbers: elements that are given no value stay undefined.
template <class T>
struct PageAllocator {
  using value_type = T;
  PageAllocator() = default;
  template <class U>
  PageAllocator(const PageAllocator<U>&) {}
  T* allocate(std::size_t count) { return static_cast<T*>(take_pages(count * sizeof(T))); }
  void deallocate(T* data, std::size_t count) noexcept { give_pages(data, count * sizeof(T)); }
  template <class U>
  void construct(U* element) {
    ::new (static_cast<void*>(element)) U;
  }
  template <class U, class... Arguments>
  void construct(U* element, Arguments&&... arguments) {
    ::new (static_cast<void*>(element)) U(std::forward<Arguments>(arguments)...);
  }
  bool operator==(const PageAllocator&) const { return true; }
};

}  // namespace carve
