#include "carve/carving/stroke_crossings.h"

#include <algorithm>

#include "carve/grid/cut_edges.h"
#include "carve/grid/shadow.h"

namespace carve {
namespace {

/// Of the edge that ends at voxel `upper`, how far from its lower centre a view's border crosses it; 0 if none does.
float from_lower(const RegionBorders& view, const ShadowLayout& layout, int axis, const Vec3i& upper) {
  const Frame& f = layout.frame;
  if (f.toward.axis == axis) return 0;
  const auto pixel = [&](const Vec3i& at) {
    return std::pair(layout.right_index(at[f.right.axis]), layout.up_index(at[f.up.axis]));
  };
  const auto low = pixel(upper - Vec3i::Unit(axis)), high = pixel(upper);
  const auto [i, j] = std::min(low, high);
  const float at = f.right.axis == axis ? view.right(i, j) : view.below(i, j);
  return at == 0 || low < high ? at : 1 - at;
}

struct StrokePlaces {
  std::span<const RegionBorders> views;
  std::span<const ShadowLayout> layouts;

  void enter(int /*z*/) {}
  float operator()(int axis, const Vec3i& upper, bool upper_inside) const {
    float nearest = 0;
    for (std::size_t v = 0; v < views.size(); ++v) {
      const float at = from_lower(views[v], layouts[v], axis, upper);
      if (at == 0) continue;
      const float distance = upper_inside ? 1 - at : at;
      if (nearest == 0 || distance < nearest) nearest = distance;
    }
    return nearest;
  }
};

}  // namespace

AxisCrossings stroke_crossings(const VoxelGrid& hull, const VoxelGrid& kept, std::span<const RegionBorders> views) {
  std::vector<ShadowLayout> layouts;
  for (const RegionBorders& view : views) layouts.emplace_back(hull.size(), view.view);
  return cut_edges(hull, kept, [&](int) { return StrokePlaces{views, layouts}; });
}

}  // namespace carve
