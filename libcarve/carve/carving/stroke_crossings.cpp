#include "carve/carving/stroke_crossings.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "carve/grid/cut_edges.h"
#include "carve/grid/shadow.h"

namespace carve {
namespace {

/// What one view shows of the solid.
class BorderView {
 public:
  BorderView(const RegionBorders& borders, const VoxelGrid& kept)
      : borders_(borders), layout_(kept.size(), borders.view), depth_(depth(kept, borders.view)) {}

  /// How far from the lower centre of an edge a border crosses it; 0 where none does.
  float operator()(int axis, const Vec3i& lower, const Vec3i& upper) const {
    const Frame& f = layout_.frame;
    if (f.toward.axis == axis) return 0;
    const std::array<int, 2> low = pixel(lower), high = pixel(upper);
    const auto [i, j] = std::min(low, high);
    const float at = f.right.axis == axis ? borders_.right(i, j) : borders_.below(i, j);
    return at == 0 || low < high ? at : 1 - at;
  }

  /// Nothing hides the voxel.
  bool sees(const Vec3i& at) const {
    const auto [i, j] = pixel(at);
    return depth_(i, j) < 0 || layout_.toward_index(at[layout_.frame.toward.axis]) < depth_(i, j);
  }

 private:
  std::array<int, 2> pixel(const Vec3i& at) const {
    return {layout_.right_index(at[layout_.frame.right.axis]), layout_.up_index(at[layout_.frame.up.axis])};
  }

  const RegionBorders& borders_;
  ShadowLayout layout_;
  Raster<int> depth_;
};

struct StrokePlaces {
  std::span<const BorderView> views;

  void enter(int /*z*/) {}
  float operator()(int axis, const Vec3i& upper, bool upper_inside) const {
    const Vec3i lower = upper - Vec3i::Unit(axis);
    std::pair best(true, 2.f);  // hidden, how far from the inside centre
    for (const BorderView& view : views)
      if (const float at = view(axis, lower, upper); at > 0)
        best = std::min(best, std::pair(!view.sees(upper_inside ? lower : upper), upper_inside ? 1 - at : at));
    return best.second < 1 ? best.second : 0;
  }
};

}  // namespace

AxisCrossings stroke_crossings(const VoxelGrid& hull, const VoxelGrid& kept, std::span<const RegionBorders> views) {
  std::vector<BorderView> seen;
  for (const RegionBorders& view : views) seen.emplace_back(view, kept);
  return cut_edges(hull, kept, [&](int) { return StrokePlaces{seen}; });
}

}  // namespace carve
