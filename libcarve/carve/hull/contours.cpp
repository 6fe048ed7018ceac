#include "carve/hull/contours.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "carve/core/options.h"
#include "carve/hull/simplify.h"
#include "carve/hull/trace.h"

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

Silhouette silhouette(const std::vector<Pixels>& shown, int axis) {
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
  return {axis, shown[0].view->view, hull::trace(mask, borders[0], borders[1])};
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
    std::vector<Pixels> shown;
    for (const AlignedView& view : views.views)
      if (frame(view.view).toward.axis == axis) shown.push_back(in_lattice(view, views, axis, size));
    if (shown.empty()) continue;
    Silhouette one = silhouette(shown, axis);
    std::array<double, 2> pixel;  // in lattice units
    for (int k = 0; k < 2; ++k) {
      const int along = (axis + 1 + k) % 3;
      pixel[k] = 1 / std::abs(pixel_line(*shown[0].view, along).second * all.unit[along]);
    }
    one.loops = hull::simplified(one.loops, options.tolerance, pixel);
    all.along.push_back(std::move(one));
  }
  return all;
}

}  // namespace carve
