#include "carve/core/pages.h"

#include <sys/mman.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <cstdint>
#include <cstdlib>
#include <mutex>

namespace carve {
namespace {

constexpr std::size_t kHugePage = std::size_t{2} << 20;
constexpr std::size_t kLarge = std::size_t{1} << 20;

std::size_t rounded(std::size_t bytes) {
  const std::size_t unit = bytes >= kLarge ? kHugePage : 64;
  return (bytes + unit - 1) / unit * unit;
}

class KeptBlocks {
 public:
  KeptBlocks() { blocks_.reserve(8); }  // keep() must not allocate

  /// A kept block of that size; else nothing is kept any more, since the sizes in use have changed.
  void* take(std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    for (auto block = blocks_.begin(); block != blocks_.end(); ++block)
      if (block->second == bytes) {
        void* data = block->first;
        total_ -= bytes;
        blocks_.erase(block);
        return data;
      }
    release();
    return nullptr;
  }

  bool keep(void* data, std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    if (total_ + bytes > kKeptBytes || blocks_.size() == blocks_.capacity()) return false;
    blocks_.emplace_back(data, bytes);
    total_ += bytes;
    return true;
  }

 private:
  void release() {
    for (const auto& [data, bytes] : blocks_) std::free(data);
    blocks_.clear();
    total_ = 0;
  }
  std::mutex mutex_;
  std::size_t total_ = 0;
  std::vector<std::pair<void*, std::size_t>> blocks_;
};

KeptBlocks& kept_blocks() {
  static KeptBlocks* blocks = new KeptBlocks;  // outlives every grid, static ones too
  return *blocks;
}

}  // namespace

void prefer_huge_pages(void* data, std::size_t bytes) {
#ifdef MADV_HUGEPAGE
  const auto begin = (reinterpret_cast<std::uintptr_t>(data) + kHugePage - 1) / kHugePage * kHugePage;
  const auto end = (reinterpret_cast<std::uintptr_t>(data) + bytes) / kHugePage * kHugePage;
  if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);  // advice: may fail
#else
  static_cast<void>(data), static_cast<void>(bytes);
#endif
}

void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
}

void* take_pages(std::size_t bytes) {
  const std::size_t size = rounded(bytes);
  const bool large = bytes >= kLarge;
  void* data = large ? kept_blocks().take(size) : nullptr;
  if (data) return data;
  data = std::aligned_alloc(large ? kHugePage : 64, size);
  if (!data && size > 0) throw std::bad_alloc();
  if (large) prefer_huge_pages(data, size);
  return data;
}

void give_pages(void* block, std::size_t bytes) noexcept {
  if (bytes < kLarge || !kept_blocks().keep(block, rounded(bytes))) std::free(block);
}

}  // namespace carve
