#include "carve/carving/patch_labels.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "carve/core/parallel.h"
#include "carve/grid/shadow.h"

namespace carve {
namespace {

/// Pixels along one side of a drawing, half-open; empty outside the drawing.
struct Interval {
  int first = 0, last = 0;
  bool operator==(const Interval&) const = default;
};

/// Of one patch along one side.
struct Extent {
  Interval patch;   // pixels whose centres lie in the patch; if there are none, those at its centre
  Interval centre;  // the pixel at the patch's centre; two if the centre lies between them
  bool operator==(const Extent&) const = default;
};

/// The pixels whose centres lie in [low, high]. Ends are taken with a tolerance, so that a mirrored drawing gives the
/// mirrored result where a patch ends on a pixel's centre.
Interval pixels_between(double low, double high, int pixels) {
  constexpr double tolerance = 1e-6;
  const auto clamped = [&](double x) { return static_cast<int>(std::clamp<double>(x, 0, pixels)); };
  const int first = clamped(std::ceil(low - 0.5 - tolerance)), last = clamped(std::floor(high - 0.5 + tolerance) + 1);
  return first < last ? Interval{first, last} : Interval{};
}

/// \param start, step  pixel coordinate of the first patch's lower end, and the patches' (signed) width
std::vector<Extent> extents(int patches, double start, double step, int pixels) {
  std::vector<Extent> result(patches);
  for (int i = 0; i < patches; ++i) {
    const double a = start + step * i, b = start + step * (i + 1), centre = start + step * (i + 0.5);
    result[i].centre = pixels_between(centre - 0.5, centre + 0.5, pixels);
    result[i].patch = pixels_between(std::min(a, b), std::max(a, b), pixels);
    if (result[i].patch == Interval{}) result[i].patch = result[i].centre;
  }
  return result;
}

class Projection {
 public:
  Projection(const AlignedView& view, const VoxelGrid& grid, Patch patch)
      : labels_(view.drawing.labels), layout_(grid.size(), view.view), patch_(patch) {
    const auto [right, up, toward] = layout_.frame;
    const double left = right.sign > 0 ? 0 : layout_.width, top = up.sign > 0 ? layout_.height : 0;
    columns_ = extents(layout_.width, view.column(grid.low()[right.axis] + grid.spacing() * left),
                       view.column_per_unit * grid.spacing() * right.sign, labels_.width);
    rows_ = extents(layout_.height, view.row(grid.low()[up.axis] + grid.spacing() * top),
                    -view.row_per_unit * grid.spacing() * up.sign, labels_.height);
  }

  void rows(int first, int last, PatchLabels& out) const {
    std::vector<std::uint8_t> line(labels_.width);
    const int width = layout_.width;
    for (int j = first; j < last; ++j) {
      std::uint8_t* labels = &out.labels(0, j);
      std::uint8_t* inside = &out.inside(0, j);
      if (j > first && rows_[j] == rows_[j - 1]) {  // a grid finer than the drawing repeats rows
        std::memcpy(labels, labels - width, width);
        std::memcpy(inside, inside - width, width);
        continue;
      }
      if (patch_ == Patch::centre) {
        gather(rows_[j].centre, &Extent::centre, line, inside);
        for (int i = 0; i < width; ++i) inside[i] = (inside[i] & (kSurface | kEdge)) != 0;
      }
      gather(rows_[j].patch, &Extent::patch, line, labels);
      if (patch_ == Patch::any)
        for (int i = 0; i < width; ++i) inside[i] = (labels[i] & (kSurface | kEdge)) != 0;
    }
  }

 private:
  /// Labels of the pixels in `row` and each patch's (or patch centre's) columns, or-ed: first down, then across.
  void gather(const Interval& row, Interval Extent::*columns, std::vector<std::uint8_t>& line,
              std::uint8_t* out) const {
    std::ranges::fill(line, row == Interval{} ? std::uint8_t{kBackground} : std::uint8_t{0});
    for (int y = row.first; y < row.last; ++y) {
      const Label* labels = &labels_(0, y);
      for (int x = 0; x < labels_.width; ++x) {
        const auto label = static_cast<std::uint8_t>(labels[x]);
        line[x] |= label + 1 + (label == 2);  // 1 << label
      }
    }
    for (int i = 0; i < layout_.width; ++i) {
      const Interval column = columns_[i].*columns;
      std::uint8_t label = column == Interval{} ? std::uint8_t{kBackground} : line[column.first];
      for (int x = column.first + 1; x < column.last; ++x) label |= line[x];
      out[i] = label;
    }
  }

  const Raster<Label>& labels_;
  ShadowLayout layout_;
  Patch patch_;
  std::vector<Extent> columns_, rows_;
};

}  // namespace

PatchLabels patch_labels(const AlignedView& view, const VoxelGrid& grid, Patch patch) {
  const ShadowLayout layout(grid.size(), view.view);
  PatchLabels result{view.view, Raster<std::uint8_t>(layout.width, layout.height), Mask(layout.width, layout.height)};
  const Projection projection(view, grid, patch);
  parallel_ranges(0, layout.height, 64, [&](int first, int last) { projection.rows(first, last, result); });
  return result;
}

}  // namespace carve
