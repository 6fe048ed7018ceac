#include "carve/carving/convex_as_printed.h"

#include <algorithm>

#include "carve/carving/row_hull.h"
#include "carve/core/bounds.h"
#include "carve/grid/shadow.h"

namespace carve {
namespace {

Box box_of(const Mask& mask) {
  return bounds(mask, [](std::uint8_t inside) { return inside != 0; });
}

bool is_convex(const Mask& mask) {
  RowHull hull;
  int pixels = 0;
  for (int y = 0; y < mask.height; ++y) {
    const auto first = mask.pixels.begin() + static_cast<std::ptrdiff_t>(y) * mask.width, last = first + mask.width;
    const auto begin = std::find(first, last, 1);
    if (begin == last) continue;
    int end = mask.width;
    while (!first[end - 1]) --end;
    hull.add(y, static_cast<int>(begin - first), end);
    pixels += static_cast<int>(std::count(begin, last, 1));
  }
  return pixels > 0 && pixels >= kConvex * hull.area();
}

/// Row `depth` of the algorithm: the grid's slice so far from the viewer, as a picture.
void cut_slice(VoxelGrid& grid, const ShadowLayout& layout, int depth, const Mask& mask, const Box& whole) {
  const auto voxel = [&](int i, int j) {
    Vec3i at;
    at[layout.frame.right.axis] = layout.right_index(i);
    at[layout.frame.up.axis] = layout.up_index(j);
    at[layout.frame.toward.axis] = depth;
    return at;
  };
  Mask slice(layout.width, layout.height);
  for (int j = 0; j < layout.height; ++j)
    for (int i = 0; i < layout.width; ++i) {
      const Vec3i at = voxel(i, j);
      slice(i, j) = grid(at.x(), at.y(), at.z());
    }
  const Box box = box_of(slice);
  if (box.empty()) return;
  const double across = static_cast<double>(whole.width()) / box.width();
  const double along = static_cast<double>(whole.height()) / box.height();
  for (int j = box.y0; j < box.y1; ++j)
    for (int i = box.x0; i < box.x1; ++i) {
      const int x = whole.x0 + static_cast<int>((i + 0.5 - box.x0) * across);
      const int y = whole.y0 + static_cast<int>((j + 0.5 - box.y0) * along);
      if (!slice(i, j) || mask(x, y)) continue;
      const Vec3i at = voxel(i, j);
      grid.set(at.x(), at.y(), at.z(), false);
    }
}

}  // namespace

VoxelGrid refine_convex_as_printed(const VoxelGrid& solid, const ViewSet& views) {
  VoxelGrid grid = solid;
  for (const AlignedView& view : views.views) {
    const ShadowLayout layout(solid.size(), view.view);
    const Mask mask = shadow(solid, view.view);
    if (!is_convex(mask)) continue;
    const Box whole = box_of(mask);
    for (int depth = 0; depth < layout.depth; ++depth) cut_slice(grid, layout, depth, mask, whole);
  }
  return grid;
}

}  // namespace carve
