#include "carve/core/pages.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>

namespace carve {
namespace {

TEST(Pages, LiveBlocksAreAlignedAndNeverOverlap) {
  std::vector<std::pair<unsigned char*, std::size_t>> blocks;
  for (std::size_t bytes : {1, 63, 64, 65, 1 << 20, 3 << 20, 3 << 20, 5 << 20}) {
    auto* block = static_cast<unsigned char*>(take_pages(bytes));
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(block) % 64, 0u);
    std::memset(block, static_cast<int>(blocks.size()), bytes);
    blocks.emplace_back(block, bytes);
  }
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    EXPECT_EQ(blocks[i].first[0], i);
    EXPECT_EQ(blocks[i].first[blocks[i].second - 1], i);
    give_pages(blocks[i].first, blocks[i].second);
  }
}

TEST(Pages, ALargeBlockServesTheNextOneOfItsSize) {
  void* first = take_pages(std::size_t{10} << 20);
  give_pages(first, std::size_t{10} << 20);
  void* second = take_pages(std::size_t{10} << 20);
  EXPECT_EQ(first, second);
  void* third = take_pages(std::size_t{10} << 20);
  EXPECT_NE(second, third);
  give_pages(second, std::size_t{10} << 20);
  give_pages(third, std::size_t{10} << 20);
}

TEST(Pages, VectorsCopyAndCompareAsEver) {
  using Words = std::vector<std::uint64_t, PageAllocator<std::uint64_t>>;
  const Words a(1 << 18, 7);
  Words b = a;
  EXPECT_EQ(a, b);
  b.back() = 8;
  EXPECT_NE(a, b);
  std::vector<std::array<int, 3>> plain;
  resize_on_huge_pages(plain, 500000);
  EXPECT_EQ(plain.size(), 500000u);
  EXPECT_EQ(plain.back(), (std::array<int, 3>{}));
}

}  // namespace
}  // namespace carve
