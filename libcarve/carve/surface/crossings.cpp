#include "carve/surface/crossings.h"

#include <algorithm>
#include <cmath>

#include "carve/carving/patch_labels.h"
#include "carve/core/parallel.h"
#include "carve/grid/shadow.h"

namespace carve {
namespace {

constexpr double kLevel = 127.5;     // of 255: half covered
constexpr double kClearance = 0.02;  // voxels between a crossing and the centres

/// The coverage along one pixel row or column; where the line runs between two, their mean.
class CoverageLine {
 public:
  /// \param across  pixel coordinate of the line
  CoverageLine(const Mask& coverage, bool along_rows, double across) : coverage_(coverage), along_rows_(along_rows) {
    low_ = static_cast<int>(std::floor(across - 1e-6));
    high_ = static_cast<int>(std::floor(across + 1e-6));
  }

  /// Position of the first crossing from `from` (inside) to `to` (outside), as a share of the way.
  double crossing(double from, double to) const {
    const double direction = to > from ? 1 : -1;
    double x = from, value = at(from);
    if (value < kLevel) return 0;
    while (x != to) {
      // The next pixel centre on the way: coverage is linear up to there.
      const double centre = (direction > 0 ? std::floor(x - 0.5) + 1 : std::ceil(x - 0.5) - 1) + 0.5;
      const double next = (to - centre) * direction > 0 ? centre : to;
      const double next_value = at(next);
      if (next_value < kLevel) {
        const double position = x + (next - x) * (value - kLevel) / (value - next_value);
        return (position - from) / (to - from);
      }
      x = next;
      value = next_value;
    }
    return 1;
  }

 private:
  double pixel(int x, int across) const {
    if (!along_rows_) std::swap(x, across);
    return coverage_.contains(x, across) ? coverage_(x, across) : 0;
  }
  double at(double x) const {
    const double before = std::floor(x - 0.5), weight = x - 0.5 - before;
    const int i = static_cast<int>(before);
    const auto interpolated = [&](int across) {
      return (1 - weight) * pixel(i, across) + weight * pixel(i + 1, across);
    };
    return low_ == high_ ? interpolated(low_) : (interpolated(low_) + interpolated(high_)) / 2;
  }

  const Mask& coverage_;
  bool along_rows_;
  int low_, high_;
};

/// What two views of one plane say together: the nearer of two crossings; nothing if they contradict each other.
float nearer(float a, float b) {
  if (a == 0) return b;
  if (b == 0) return a;
  if ((a > 0) != (b > 0)) return 0;
  return std::abs(a) < std::abs(b) ? a : b;
}

class ViewContour {
 public:
  ViewContour(const AlignedView& view, const VoxelGrid& grid)
      : view_(view), grid_(grid), layout_(grid.size(), view.view), inside_(patch_labels(view, grid).inside) {}

  /// The crossings along the view's right axis (or up axis), or-ed into the plane's entries for that axis.
  void add(bool along_right, bool axis_is_first, Raster<float>& plane) const {
    const int lines = along_right ? layout_.height : layout_.width,
              length = along_right ? layout_.width : layout_.height;
    parallel_ranges(0, lines, 16, [&](int begin, int end) {
      for (int line = begin; line < end; ++line) {
        const CoverageLine coverage(view_.drawing.coverage, along_right, pixel(!along_right, line));
        for (int i = 0; i <= length; ++i) {
          const bool lower = inside(along_right, i - 1, line), upper = inside(along_right, i, line);
          if (lower == upper) continue;
          const double low = pixel(along_right, i - 1), high = pixel(along_right, i);
          const double share = lower ? coverage.crossing(low, high) : coverage.crossing(high, low);
          const auto distance = static_cast<float>(std::clamp(share, kClearance, 1 - kClearance));
          float& entry = axis_is_first ? plane(i, line) : plane(line, i);
          entry = nearer(entry, lower ? distance : -distance);
        }
      }
    });
  }

  void add(PlaneCrossings& plane) const {
    const int right = layout_.frame.right.axis, up = layout_.frame.up.axis;
    add(true, right < up, right < up ? plane.first : plane.second);
    add(false, up < right, up < right ? plane.first : plane.second);
  }

 private:
  /// Pixel coordinate of a voxel centre's index along the right axis (or up axis).
  double pixel(bool along_right, int index) const {
    const int axis = along_right ? layout_.frame.right.axis : layout_.frame.up.axis;
    const double place = grid_.low()[axis] + grid_.spacing() * (index + 0.5);
    return along_right ? view_.column(place) : view_.row(place);
  }
  bool inside(bool along_right, int index, int line) const {
    const int right = along_right ? index : line, up = along_right ? line : index;
    const int i = layout_.right_index(right), j = layout_.up_index(up);
    return inside_.contains(i, j) && inside_(i, j);
  }

  const AlignedView& view_;
  const VoxelGrid& grid_;
  ShadowLayout layout_;
  Mask inside_;
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
    ViewContour(view, grid).add(plane);
  }
  return result;
}

}  // namespace carve
