#include "carve/views/view_set.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "carve/core/error.h"
#include "carve/image/outline.h"

namespace carve {
namespace {

using Drawings = std::map<View, Drawing>;
using Bounds = std::map<View, OutlineBounds>;

Drawings renamed(Drawings drawings, const AlignOptions& options) {
  if (!options.side_from_left) return drawings;
  if (drawings.contains(View::left))
    throw std::invalid_argument("align.side_from_left must be off where a left drawing is given beside the side one");
  auto side = drawings.extract(View::side);
  if (side) {
    side.key() = View::left;
    drawings.insert(std::move(side));
  }
  return drawings;
}

std::vector<View> flipped_views(const AlignOptions& options) {
  std::vector<View> flipped;
  for (const std::string& text : options.flip) {
    const auto view = std::ranges::find_if(kViews, [&](View v) { return text == name(v); });
    if (view == kViews.end())
      throw std::invalid_argument("align.flip must be one of front|side|top|back|left|bottom, got " + text);
    flipped.push_back(*view);
  }
  return flipped;
}

bool shows(View view, int axis) { return frame(view).right.axis == axis || frame(view).up.axis == axis; }

void check_axes(const Drawings& drawings) {
  static constexpr const char* axes[] = {"x (width)", "y (height)", "z (depth)"};
  for (int axis : {2, 1, 0}) {
    if (std::ranges::any_of(drawings, [&](const auto& entry) { return shows(entry.first, axis); })) continue;
    std::string given, wanted;
    for (const auto& [view, drawing] : drawings) given += std::string(given.empty() ? "" : ", ") + name(view);
    for (View view : kViews)
      if (shows(view, axis)) wanted += std::string(wanted.empty() ? "" : ", ") + name(view);
    throw std::invalid_argument("views must show all three axes, got " + (given.empty() ? "none" : given) +
                                ": nothing shows " + axes[axis] + ", add one of " + wanted);
  }
}

void check_drawing(View view, const Drawing& drawing) {
  const Box& box = drawing.bounds;
  if (box.empty()) throw NoResult(std::string(name(view)) + ": the drawing shows nothing but background");
  if (box.x0 < 0 || box.y0 < 0 || box.x1 > drawing.labels.width || box.y1 > drawing.labels.height)
    throw std::invalid_argument(std::string(name(view)) + ": bounds must lie inside the labels");
  if (drawing.coverage.width != drawing.labels.width || drawing.coverage.height != drawing.labels.height)
    throw std::invalid_argument(std::string(name(view)) + ": coverage and labels must have one size");
}

/// Logarithms of the object's extents, up to a common summand: each drawing says log(width / height) of its box, its
/// own scale cancels out. The last equation fixes the summand.
Vec3 fit_log_size(const Bounds& bounds) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Ones();
  Vec3 rhs = Vec3::Zero();
  for (const auto& [view, box] : bounds) {
    Vec3 row = Vec3::Zero();
    row[frame(view).right.axis] = 1;
    row[frame(view).up.axis] = -1;
    normal += row * row.transpose();
    rhs += row * std::log((box.x1 - box.x0) / (box.y1 - box.y0));
  }
  return normal.ldlt().solve(rhs);
}

/// Each drawing brought to the object's scale as a whole, how far do two extents of one axis lie apart?
double largest_disagreement(const Bounds& bounds, const Vec3& log_size) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const auto& [view, box] : bounds) {
    const int right = frame(view).right.axis, up = frame(view).up.axis;
    const double log_width = std::log(box.x1 - box.x0), log_height = std::log(box.y1 - box.y0);
    const double scale = (log_width - log_size[right] + log_height - log_size[up]) / 2;
    for (const auto& [axis, extent] : {std::pair(right, log_width - scale), std::pair(up, log_height - scale)}) {
      low[axis] = std::min(low[axis], extent);
      high[axis] = std::max(high[axis], extent);
    }
  }
  return 1 - std::exp(-(high - low).maxCoeff());
}

/// The line through (low, at_low) and (low + size, at_high) as constant and slope.
std::pair<double, double> line(double low, double size, double at_low, double at_high) {
  const double slope = (at_high - at_low) / size;
  return {at_low - slope * low, slope};
}

AlignedView place(View view, Drawing drawing, const OutlineBounds& box, const ViewSet& set, bool flipped) {
  const auto [right, up, toward] = frame(view);
  AlignedView placed{view, std::move(drawing)};
  double x0 = box.x0, x1 = box.x1, y0 = box.y0, y1 = box.y1;
  if ((right.sign > 0) == flipped) std::swap(x0, x1);
  if (up.sign > 0) std::swap(y0, y1);
  std::tie(placed.column0, placed.column_per_unit) = line(set.low()[right.axis], set.size[right.axis], x0, x1);
  std::tie(placed.row0, placed.row_per_unit) = line(set.low()[up.axis], set.size[up.axis], y0, y1);
  return placed;
}

}  // namespace

const AlignedView* ViewSet::find(View view) const {
  const auto found = std::ranges::find(views, view, &AlignedView::view);
  return found == views.end() ? nullptr : &*found;
}

ViewSet align(std::map<View, Drawing> drawings, const AlignOptions& options) {
  const std::vector<View> flipped = flipped_views(options);
  drawings = renamed(std::move(drawings), options);
  check_axes(drawings);
  Bounds bounds;
  for (const auto& [view, drawing] : drawings) {
    check_drawing(view, drawing);
    bounds[view] = outline_bounds(drawing);
  }

  const Vec3 log_size = fit_log_size(bounds);
  ViewSet set;
  set.size = (log_size.array() - log_size.maxCoeff()).exp();
  set.disagreement = largest_disagreement(bounds, log_size);
  for (auto& [view, drawing] : drawings)
    set.views.push_back(place(view, std::move(drawing), bounds[view], set, std::ranges::count(flipped, view) > 0));
  return set;
}

}  // namespace carve
