#include "carve/surface/crossings.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "carve/carving/patch_labels.h"
#include "carve/core/parallel.h"
#include "carve/grid/shadow.h"
#include "carve/image/outline.h"

namespace carve {
namespace {

/// What two views of one plane say together: the nearer of two crossings; nothing if they contradict each other.
float nearer(float a, float b) {
  if (a == 0) return b;
  if (b == 0) return a;
  if ((a > 0) != (b > 0)) return 0;
  return std::abs(a) < std::abs(b) ? a : b;
}

/// One view in the coordinates of its plane: u, v = voxel indices along the plane's first and second axis.
class PlaneView {
 public:
  PlaneView(const AlignedView& view, const VoxelGrid& grid)
      : view_(view), grid_(grid), layout_(grid.size(), view.view), outline_(view.drawing.coverage) {
    const bool swapped = layout_.frame.right.axis > layout_.frame.up.axis;  // u runs along the image's columns
    first_is_right_ = !swapped;
    const Mask mask = patch_labels(view, grid).inside;
    inside_ = swapped ? Mask(mask.height, mask.width) : Mask(mask.width, mask.height);
    for (int j = 0; j < mask.height; ++j)
      for (int i = 0; i < mask.width; ++i) {
        const int right = layout_.right_index(i), up = layout_.up_index(j);
        (swapped ? inside_(up, right) : inside_(right, up)) = mask(i, j);
      }
  }

  void add_crossings(PlaneCrossings& plane) const {
    const int width = inside_.width, height = inside_.height;
    parallel_ranges(0, height + 1, 32, [&](int begin, int end) {
      const std::vector<std::uint8_t> outside(width, 0);
      std::vector<std::uint8_t> shifted(width + 2, 0);
      for (int v = begin; v < end; ++v) {
        const std::uint8_t* row = v < height ? &inside_(0, v) : outside.data();
        const std::uint8_t* before = v > 0 ? &inside_(0, v - 1) : outside.data();
        each_difference(before, row, width, [&](int u, bool lower) {
          add(plane.second(u, v), lower, crossing(!first_is_right_, u, v - 1, v, lower));
        });
        if (v == height) continue;
        std::memcpy(shifted.data() + 1, row, width);
        each_difference(shifted.data(), shifted.data() + 1, width + 1, [&](int u, bool lower) {
          add(plane.first(u, v), lower, crossing(first_is_right_, v, u - 1, u, lower));
        });
      }
    });
  }

 private:
  /// Calls found(i, lower[i]) where two rows of 0 and 1 differ; eight entries are compared at a time.
  template <class Found>
  static void each_difference(const std::uint8_t* lower, const std::uint8_t* upper, int count, Found&& found) {
    for (int i = 0; i < count;) {
      if (i + 8 <= count && std::memcmp(lower + i, upper + i, 8) == 0) {
        i += 8;
        continue;
      }
      const int end = std::min(count, i + 8);
      for (; i < end; ++i)
        if (lower[i] != upper[i]) found(i, lower[i] != 0);
    }
  }

  static void add(float& entry, bool lower_inside, float distance) {
    entry = nearer(entry, lower_inside ? distance : -distance);
  }

  /// Distance in voxels from the inside one of the centres low and high = low + 1, on the grid line at index `across`.
  float crossing(bool along_right, int across, int low, int high, bool lower_inside) const {
    const double line = pixel(!along_right, across);
    const double from = pixel(along_right, lower_inside ? low : high),
                 to = pixel(along_right, lower_inside ? high : low);
    const double left =
        along_right ? outline_.leave_along_row(from, to, line) : outline_.leave_along_column(from, to, line);
    return std::clamp(static_cast<float>((left - from) / (to - from)), kClearance, 1 - kClearance);
  }

  /// Pixel coordinate of a voxel's centre, by its index along the view's right (or up) axis.
  double pixel(bool along_right, int index) const {
    const int axis = along_right ? layout_.frame.right.axis : layout_.frame.up.axis;
    const double place = grid_.low()[axis] + grid_.spacing() * (index + 0.5);
    return along_right ? view_.column(place) : view_.row(place);
  }

  const AlignedView& view_;
  const VoxelGrid& grid_;
  ShadowLayout layout_;
  Outline outline_;
  bool first_is_right_ = true;
  Mask inside_;  // (u, v)
};

}  // namespace

Crossings contour_crossings(const ViewSet& views, const VoxelGrid& grid) {
  Crossings result;
  for (const AlignedView& view : views.views) {
    const int seen_along = frame(view.view).toward.axis;
    PlaneCrossings& plane = seen_along == 2 ? result.xy : seen_along == 1 ? result.xz : result.yz;
    if (plane.first.empty()) {
      const int first = seen_along == 0 ? grid.size().y() : grid.size().x();
      const int second = seen_along == 2 ? grid.size().y() : grid.size().z();
      plane = {Raster<float>(first + 1, second), Raster<float>(first, second + 1)};
    }
    PlaneView(view, grid).add_crossings(plane);
  }
  return result;
}

}  // namespace carve
