#include "carve/grid/shadow.h"

#include <bit>

#include "carve/core/parallel.h"

namespace carve {
namespace {

/// Depth along x: the first bit of the row from the viewer's end.
int row_depth(const VoxelGrid& grid, int y, int z, int sign) {
  const std::uint64_t* row = grid.row(y, z);
  const int words = grid.words_per_row();
  if (sign > 0) {
    for (int w = words - 1; w >= 0; --w)
      if (row[w]) return grid.size().x() - 1 - (64 * w + 63 - std::countl_zero(row[w]));
  } else {
    for (int w = 0; w < words; ++w)
      if (row[w]) return 64 * w + std::countr_zero(row[w]);
  }
  return -1;
}

/// One pixel row of a view along y or z: rows of bits are looked at from the viewer's end, each bit counts once.
void bits_depth(const VoxelGrid& grid, const ShadowLayout& layout, int j, int* pixels) {
  const int words = grid.words_per_row(), up = layout.up_index(j);
  std::vector<std::uint64_t> seen(words, 0);
  for (int d = 0; d < layout.depth; ++d) {
    const int layer = layout.toward_index(d);
    const std::uint64_t* row = layout.frame.toward.axis == 2 ? grid.row(up, layer) : grid.row(layer, up);
    for (int w = 0; w < words; ++w) {
      for (std::uint64_t fresh = row[w] & ~seen[w]; fresh; fresh &= fresh - 1)
        pixels[layout.right_index(64 * w + std::countr_zero(fresh))] = d;
      seen[w] |= row[w];
    }
  }
}

}  // namespace

Raster<int> depth(const VoxelGrid& grid, View view) {
  const ShadowLayout layout(grid.size(), view);
  Raster<int> result(layout.width, layout.height, -1);
  parallel_ranges(0, layout.height, 8, [&](int first, int last) {
    for (int j = first; j < last; ++j) {
      if (layout.frame.toward.axis != 0) {
        bits_depth(grid, layout, j, &result(0, j));
        continue;
      }
      for (int i = 0; i < layout.width; ++i)
        result(i, j) = row_depth(grid, layout.up_index(j), layout.right_index(i), layout.frame.toward.sign);
    }
  });
  return result;
}

Mask shadow(const VoxelGrid& grid, View view) {
  const ShadowLayout layout(grid.size(), view);
  Mask result(layout.width, layout.height);
  parallel_ranges(0, layout.height, 8, [&](int first, int last) {
    std::vector<std::uint64_t> any;
    for (int j = first; j < last; ++j) {
      const int up = layout.up_index(j);
      if (layout.frame.toward.axis == 0) {
        for (int i = 0; i < layout.width; ++i) result(i, j) = row_depth(grid, up, layout.right_index(i), 1) >= 0;
        continue;
      }
      any.assign(grid.words_per_row(), 0);
      for (int d = 0; d < layout.depth; ++d) {
        const std::uint64_t* row = layout.frame.toward.axis == 2 ? grid.row(up, d) : grid.row(d, up);
        for (std::size_t w = 0; w < any.size(); ++w) any[w] |= row[w];
      }
      for (int i = 0; i < layout.width; ++i) {
        const int x = layout.right_index(i);
        result(i, j) = any[x >> 6] >> (x & 63) & 1;
      }
    }
  });
  return result;
}

}  // namespace carve
