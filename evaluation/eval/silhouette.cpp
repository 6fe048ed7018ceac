#include "eval/silhouette.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "carve/core/options.h"
#include "eval/distance_transform.h"
#include "eval/rasterise.h"

namespace carve {
namespace {

struct Box3 {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
};

Box3 box_of(const Mesh& mesh) {
  Box3 box;
  for (const Triangle& triangle : mesh.triangles)
    for (const int corner : triangle) {
      box.low = box.low.cwiseMin(mesh.positions[corner]);
      box.high = box.high.cwiseMax(mesh.positions[corner]);
    }
  return box;
}

bool in_object_units(const Box3& box, const ViewSet& views) {
  return std::max((box.low - views.low()).cwiseAbs().maxCoeff(), (box.high - views.high()).cwiseAbs().maxCoeff()) < 0.1;
}

Mesh stretched(Mesh mesh, const Box3& from, const ViewSet& views) {
  const Vec3 scale = views.size.cwiseQuotient(from.high - from.low);
  for (Vec3& p : mesh.positions) p = views.low() + scale.cwiseProduct(p - from.low);
  return mesh;
}

// The drawing's pixels in the camera's plane.
Window window_of(const AlignedView& view) {
  const Frame f = frame(view.view);
  const double right = view.column_per_unit * f.right.sign, up = view.row_per_unit * f.up.sign;
  return {
      view.drawing.labels.width, view.drawing.labels.height, -view.column0 / right, 1 / right, -view.row0 / up, 1 / up};
}

// The window with as many more pixels as the mesh needs, at most a drawing's size on each side: what sticks out of the
// picture is extra too. (x, y) is where the drawing's first pixel comes to lie.
struct Padded {
  Window window;
  int x = 0, y = 0;
};

Padded padded(Window window, const Mesh& mesh, const CameraAxes& axes) {
  const int most = std::max(window.width, window.height);
  double x0 = 0, x1 = window.width, y0 = 0, y1 = window.height;
  for (const Triangle& triangle : mesh.triangles)
    for (const int corner : triangle) {
      const double x = (mesh.positions[corner].dot(axes.right) - window.right0) / window.right_per_pixel;
      const double y = (mesh.positions[corner].dot(axes.up) - window.up0) / window.up_per_pixel;
      x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
    }
  const auto pixels = [most](double beyond) { return static_cast<int>(std::ceil(std::min<double>(most, beyond))); };
  const int left = pixels(-x0), top = pixels(-y0);
  window.right0 -= left * window.right_per_pixel;
  window.up0 -= top * window.up_per_pixel;
  window.width += left + pixels(x1 - window.width);
  window.height += top + pixels(y1 - window.height);
  return {window, left, top};
}

template <class Test>
Mask mask_where(int width, int height, const Test& test) {
  Mask mask(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) mask(x, y) = test(x, y) ? 1 : 0;
  return mask;
}

// Both sides of every jump in depth, the outline's included.
Mask rendered_strokes(const Raster<double>& depth, double jump) {
  Mask strokes(depth.width, depth.height);
  const auto compare = [&](int x, int y, int u, int v) {
    if (!depth.contains(u, v)) return;
    const double here = depth(x, y), there = depth(u, v);
    if (here == there || !(std::abs(here - there) > jump)) return;
    if (here != Seen::kNothing) strokes(x, y) = 1;
    if (there != Seen::kNothing) strokes(u, v) = 1;
  };
  for (int y = 0; y < depth.height; ++y)
    for (int x = 0; x < depth.width; ++x) {
      compare(x, y, x + 1, y);
      compare(x, y, x, y + 1);
    }
  return strokes;
}

// Share of the pixels of `strokes` within `region` that lie within `reach` of one of `others`.
std::optional<double> share_matched(const Mask& strokes, const Mask& region, const Mask& others, double reach) {
  const Raster<float> distance = distance_transform(others);
  std::int64_t all = 0, matched = 0;
  for (std::size_t i = 0; i < strokes.pixels.size(); ++i) {
    if (!strokes.pixels[i] || !region.pixels[i]) continue;
    ++all;
    matched += distance.pixels[i] <= reach;
  }
  return all ? std::optional(static_cast<double>(matched) / static_cast<double>(all)) : std::nullopt;
}

Picture draw_overlay(const Mask& drawn, const Mask& covered, const Mask& drawn_strokes, const Mask& strokes) {
  Picture picture(drawn.width, drawn.height, Rgba{255, 255, 255, 255});
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    if (drawn.pixels[i] && covered.pixels[i]) picture.pixels[i] = {215, 215, 215, 255};
    if (drawn.pixels[i] && !covered.pixels[i]) picture.pixels[i] = {220, 50, 47, 255};
    if (!drawn.pixels[i] && covered.pixels[i]) picture.pixels[i] = {38, 110, 210, 255};
    if (drawn_strokes.pixels[i]) picture.pixels[i] = {0, 0, 0, 255};
    if (strokes.pixels[i]) picture.pixels[i] = {0, 170, 60, 255};
  }
  return picture;
}

ViewScore score(const Mesh& mesh, const AlignedView& view, const SilhouetteOptions& options) {
  const CameraAxes axes = camera(view.view);
  const Padded place = padded(window_of(view), mesh, axes);
  const int width = place.window.width, height = place.window.height;
  const auto label = [&](int x, int y) {
    const Raster<Label>& labels = view.drawing.labels;
    return labels.contains(x - place.x, y - place.y) ? labels(x - place.x, y - place.y) : Label::background;
  };
  const Raster<double> depth = rasterise(mesh, axes, place.window).depth;
  const Mask drawn = mask_where(width, height, [&](int x, int y) { return label(x, y) != Label::background; });
  const Mask covered = mask_where(width, height, [&](int x, int y) { return depth(x, y) != Seen::kNothing; });

  ViewScore result{view.view};
  std::int64_t both = 0;
  for (std::size_t i = 0; i < drawn.pixels.size(); ++i) {
    both += drawn.pixels[i] & covered.pixels[i];
    result.missing += drawn.pixels[i] & ~covered.pixels[i] & 1;
    result.extra += covered.pixels[i] & ~drawn.pixels[i] & 1;
  }
  result.iou =
      static_cast<double>(both) / static_cast<double>(std::max<std::int64_t>(1, both + result.missing + result.extra));

  const Mask drawn_strokes = mask_where(width, height, [&](int x, int y) { return label(x, y) == Label::edge; });
  const Mask strokes = rendered_strokes(depth, options.jump / 100);
  const double reach = options.reach / 100 * std::max(view.drawing.bounds.width(), view.drawing.bounds.height());
  const Raster<float> from_outline =
      distance_transform(mask_where(width, height, [&](int x, int y) { return !drawn(x, y) || !covered(x, y); }));
  const double outline = view.drawing.max_stroke + reach;
  const Mask inner = mask_where(width, height, [&](int x, int y) { return from_outline(x, y) > outline; });
  result.stroke_precision = share_matched(strokes, inner, drawn_strokes, reach);
  result.stroke_recall = share_matched(drawn_strokes, inner, strokes, reach);
  result.overlay = draw_overlay(drawn, covered, drawn_strokes, strokes);
  return result;
}

}  // namespace

std::optional<double> ViewScore::stroke_f() const {
  if (!stroke_precision && !stroke_recall) return std::nullopt;
  const double p = stroke_precision.value_or(0), r = stroke_recall.value_or(0);
  return p + r > 0 ? 2 * p * r / (p + r) : 0;
}

double SilhouetteScores::least_iou() const {
  double least = 1;
  for (const ViewScore& view : views) least = std::min(least, view.iou);
  return least;
}

SilhouetteScores silhouette_scores(const Mesh& mesh, const ViewSet& views, const SilhouetteOptions& options) {
  check("", options);
  if (mesh.triangles.empty()) throw std::invalid_argument("a mesh must have at least one triangle, got none");
  const Box3 box = box_of(mesh);
  SilhouetteScores scores{options.fit, {}};
  if (options.fit == Fit::automatic) scores.fit = in_object_units(box, views) ? Fit::object : Fit::box;
  if (scores.fit == Fit::box && !((box.high - box.low).minCoeff() > 0))
    throw std::invalid_argument("the mesh is flat: its box cannot be stretched onto the drawings'");
  const Mesh placed = scores.fit == Fit::box ? stretched(mesh, box, views) : mesh;
  for (const AlignedView& view : views.views) scores.views.push_back(score(placed, view, options));
  return scores;
}

}  // namespace carve
