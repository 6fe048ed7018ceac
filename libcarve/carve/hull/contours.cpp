#include "carve/hull/contours.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "carve/core/options.h"
#include "carve/hull/simplify.h"
#include "carve/hull/trace.h"
#include "carve/image/outline_loops.h"

namespace carve {
namespace {

/// A view's pixels in the lattice's order: i along the silhouette's first axis, j along its second one.
struct Pixels {
  const AlignedView* view;
  bool transposed;                      // i counts rows of the drawing
  std::vector<std::int32_t> breaks[2];  // lattice coordinates of the borders between pixels, ascending
  std::vector<int> index[2];            // the drawing's column or row between two of them

  bool inside(int i, int j) const {
    const int a = index[0][i], b = index[1][j];
    const Raster<Label>& labels = view->drawing.labels;
    return (transposed ? labels(b, a) : labels(a, b)) != Label::background;
  }
};

bool along_columns(View view, int axis) { return frame(view).right.axis == axis; }

/// The pixel coordinate of object coordinate x along an axis is offset + slope * x.
std::pair<double, double> pixel_line(const AlignedView& view, int axis) {
  return along_columns(view.view, axis) ? std::pair(view.column0, view.column_per_unit)
                                        : std::pair(view.row0, view.row_per_unit);
}

// How many whole pixels the object's box covers along an axis, if it starts and ends between pixels.
std::optional<std::int64_t> whole_pixels(const AlignedView& view, const ViewSet& views, int axis) {
  const auto [offset, slope] = pixel_line(view, axis);
  const double low = offset + slope * views.low()[axis], high = offset + slope * views.high()[axis];
  const auto whole = [](double x) { return std::abs(x - std::round(x)) < 1e-6; };
  if (!whole(low) || !whole(high)) return std::nullopt;
  return static_cast<std::int64_t>(std::llround(std::abs(high - low)));
}

std::int32_t lattice_size(const ViewSet& views, int axis) {
  std::int64_t multiple = 1;
  for (const AlignedView& view : views.views) {
    if (frame(view.view).toward.axis == axis) continue;
    const auto pixels = whole_pixels(view, views, axis);
    if (!pixels) return kLattice;
    multiple = std::lcm(multiple, *pixels);
    if (multiple > kLattice) return kLattice;
  }
  return static_cast<std::int32_t>(kLattice / multiple * multiple);
}

Pixels in_lattice(const AlignedView& view, const ViewSet& views, int axis, const Vec3i& size) {
  Pixels pixels{&view, false, {}, {}};
  for (int k = 0; k < 2; ++k) {
    const int along = (axis + 1 + k) % 3;
    const bool columns = along_columns(view.view, along);
    if (k == 0) pixels.transposed = !columns;
    const Box& box = view.drawing.bounds;
    const int first = columns ? box.x0 : box.y0, last = columns ? box.x1 : box.y1;
    const auto [offset, slope] = pixel_line(view, along);
    // The outermost borders become the box's: bounds are told to a fraction of a pixel, these pixels' borders are not.
    const double pixel = std::abs(size[along] / (slope * views.size[along]));
    const auto place = [&, offset = offset, slope = slope](int border) {
      const double x = size[along] * ((border - offset) / slope - views.low()[along]) / views.size[along];
      const bool outermost = border == first || border == last;
      if (outermost && std::abs(x) < 0.9 * pixel) return 0;
      if (outermost && std::abs(x - size[along]) < 0.9 * pixel) return size[along];
      return static_cast<int>(std::clamp<double>(std::round(x), 0, size[along]));
    };
    for (int step = 0; step <= last - first; ++step) {
      const int border = slope > 0 ? first + step : last - step;
      const std::int32_t at = place(border);
      if (!pixels.breaks[k].empty() && at < pixels.breaks[k].back() + 4) continue;
      if (!pixels.breaks[k].empty()) pixels.index[k].push_back(slope > 0 ? border - 1 : border);
      pixels.breaks[k].push_back(at);
    }
  }
  return pixels;
}

// Borders of either, those nearer than 4 to each other taken as one.
std::vector<std::int32_t> merged(const std::vector<std::int32_t>& p, const std::vector<std::int32_t>& q) {
  std::vector<std::int32_t> all;
  std::merge(p.begin(), p.end(), q.begin(), q.end(), std::back_inserter(all));
  std::vector<std::int32_t> kept;
  for (const std::int32_t x : all)
    if (kept.empty() || x >= kept.back() + 4) kept.push_back(x);
  return kept;
}

// For each interval between borders, the interval of `breaks` that holds its middle, or -1.
std::vector<int> find_intervals(const std::vector<std::int32_t>& borders, const std::vector<std::int32_t>& breaks) {
  std::vector<int> found;
  for (std::size_t i = 0; i + 1 < borders.size(); ++i) {
    const double middle = (borders[i] + borders[i + 1]) / 2.0;
    const auto after = std::upper_bound(breaks.begin(), breaks.end(), middle);
    found.push_back(after == breaks.begin() || after == breaks.end() ? -1
                                                                     : static_cast<int>(after - breaks.begin()) - 1);
  }
  return found;
}

Silhouette hard_silhouette(std::span<const AlignedView* const> views_along, const ViewSet& views, int axis,
                           const Vec3i& size) {
  std::vector<Pixels> shown;
  for (const AlignedView* view : views_along) shown.push_back(in_lattice(*view, views, axis, size));
  std::vector<std::int32_t> borders[2] = {shown[0].breaks[0], shown[0].breaks[1]};
  for (std::size_t v = 1; v < shown.size(); ++v)
    for (int k = 0; k < 2; ++k) borders[k] = merged(borders[k], shown[v].breaks[k]);
  Mask mask(static_cast<int>(borders[0].size()) - 1, static_cast<int>(borders[1].size()) - 1, 1);
  for (const Pixels& pixels : shown) {
    const std::vector<int> i = find_intervals(borders[0], pixels.breaks[0]);
    const std::vector<int> j = find_intervals(borders[1], pixels.breaks[1]);
    for (int y = 0; y < mask.height; ++y)
      for (int x = 0; x < mask.width; ++x) mask(x, y) &= i[x] >= 0 && j[y] >= 0 && pixels.inside(i[x], j[y]);
  }
  return {axis, views_along[0]->view, hull::trace(mask, borders[0], borders[1])};
}

/// The lesser coverage of opposite views, in the pixels of the first.
Mask common_coverage(std::span<const AlignedView* const> shown) {
  const AlignedView& first = *shown[0];
  Mask all = first.drawing.coverage;
  for (const AlignedView* other : shown.subspan(1)) {
    const Mask& coverage = other->drawing.coverage;
    const auto at = [&](int x, int y) { return coverage.contains(x, y) ? static_cast<double>(coverage(x, y)) : 0.; };
    for (int y = 0; y < all.height; ++y)
      for (int x = 0; x < all.width; ++x) {
        const double column = other->column((x + 0.5 - first.column0) / first.column_per_unit) - 0.5;
        const double row = other->row((y + 0.5 - first.row0) / first.row_per_unit) - 0.5;
        const int i = static_cast<int>(std::floor(column)), j = static_cast<int>(std::floor(row));
        const double value = std::lerp(std::lerp(at(i, j), at(i + 1, j), column - i),
                                       std::lerp(at(i, j + 1), at(i + 1, j + 1), column - i), row - j);
        all(x, y) = std::min(all(x, y), static_cast<std::uint8_t>(std::lround(value)));
      }
  }
  return all;
}

/// The outlines as polygons. Each vertex lies on a line between two pixels' centres and at least one lattice unit from
/// both, so rounding keeps what the cells between the centres keep: no loops meet.
Silhouette soft_silhouette(std::span<const AlignedView* const> shown, const ViewSet& views, int axis,
                           const Vec3i& size) {
  const AlignedView& view = *shown[0];
  const int axes[2] = {(axis + 1) % 3, (axis + 2) % 3};
  const bool transposed = !along_columns(view.view, axes[0]);
  const bool mirrored = (view.column_per_unit < 0) != (view.row_per_unit > 0);
  const auto in_lattice = [&](double pixel, int k) {
    const auto [offset, slope] = pixel_line(view, axes[k]);
    const double x = (pixel - offset) / slope - views.low()[axes[k]];
    return static_cast<std::int32_t>(std::lround(size[axes[k]] * x / views.size[axes[k]]));
  };
  Silhouette result{axis, view.view, {}};
  for (const std::vector<OutlineCrossing>& crossings : outline_loops(common_coverage(shown))) {
    LatticeLoop& loop = result.loops.emplace_back();
    for (const OutlineCrossing& c : crossings) {
      LatticePoint point;
      for (int k = 0; k < 2; ++k) {
        const bool columns = (k == 0) != transposed;
        const int pixel = columns ? c.x : c.y;
        point[k] = in_lattice(columns ? c.place.x() : c.place.y(), k);
        if (columns != c.along_row) continue;
        const auto [low, high] = std::minmax({in_lattice(pixel + 0.5, k), in_lattice(pixel + 1.5, k)});
        point[k] = std::clamp(point[k], low + 1, std::max(low + 1, high - 1));
        // The outermost places become the box's: bounds are told to less than a lattice unit.
        if (std::abs(point[k]) <= 1) point[k] = 0;
        if (std::abs(point[k] - size[axes[k]]) <= 1) point[k] = size[axes[k]];
      }
      loop.push_back(point);
    }
    if (transposed != mirrored) std::reverse(loop.begin(), loop.end());
  }
  return result;
}

}  // namespace

Silhouettes pixel_contours(const ViewSet& views, const ContourOptions& options) {
  check("contour", options);
  Silhouettes all;
  Vec3i size;
  for (int axis = 0; axis < 3; ++axis) size[axis] = lattice_size(views, axis);
  all.origin = views.low();
  all.unit = views.size.array() / size.cast<double>().array();
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<const AlignedView*> shown;
    for (const AlignedView& view : views.views)
      if (frame(view.view).toward.axis == axis) shown.push_back(&view);
    if (shown.empty()) continue;
    Silhouette one =
        options.subpixel ? soft_silhouette(shown, views, axis, size) : hard_silhouette(shown, views, axis, size);
    std::array<double, 2> pixel;  // in lattice units
    for (int k = 0; k < 2; ++k) {
      const int along = (axis + 1 + k) % 3;
      pixel[k] = 1 / std::abs(pixel_line(*shown[0], along).second * all.unit[along]);
    }
    one.loops = hull::simplified(one.loops, options.tolerance, pixel);
    all.along.push_back(std::move(one));
  }
  return all;
}

}  // namespace carve
