#pragma once
#include <functional>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "carve/views/view_set.h"

namespace carve {

// Image coordinates of a view: along image right and image up, in object units, growing that way. They are the world's
// coordinates along the frame's axes times the axes' signs.

/// Intervals of image-right coordinates, disjoint and sorted.
using Spans = std::vector<std::pair<double, double>>;

/// A line drawn into a view, in image coordinates.
struct Stroke {
  Vec2 from, to;
};

/// A named solid in object units (longest side 1, centred on x and z, standing on y = 0) with its exact silhouettes:
/// spans(view, b) is where the line at image-up coordinate b cuts the silhouette.
struct Shape {
  std::string name;
  Vec3 size;
  double volume, hull_volume;               // of the solid; of the visual hull of front, side and top
  std::function<bool(const Vec3&)> inside;  // the solid
  std::function<Spans(View, double b)> spans;
  std::function<std::vector<Stroke>(View)> strokes = [](View) { return std::vector<Stroke>(); };  // inner edges
};

Shape box(const Vec3& size = {1, 0.75, 0.5});
Shape ball();
/// Lying in the xz plane. Its hull differs from it.
Shape torus(double tube_radius = 0.15);
/// `steps` steps rising from the front to the back, all as wide as the object; front and top show them by strokes.
Shape stairs(int steps = 4);
/// The stairs between two walls of the object's full height: their hull is the whole box, strokes tell more.
Shape walled_stairs(int steps = 4);
std::vector<Shape> all_shapes();

struct DrawOptions {
  int pixels = 128;   // along the object's longest side; the shape's box starts at a pixel's corner
  int margin = 3;     // empty pixels around it
  double stroke = 0;  // width of the drawn strokes in pixels; 0 = none
};

inline constexpr View kThreeViews[] = {View::front, View::side, View::top};

/// Exact coverage (64 lines a pixel), labels = coverage of at least one half, strokes as edges.
Drawing draw(const Shape& shape, View view, const DrawOptions& options = {});
std::map<View, Drawing> draw(const Shape& shape, std::span<const View> views = kThreeViews,
                             const DrawOptions& options = {});
ViewSet aligned(const Shape& shape, std::span<const View> views = kThreeViews, const DrawOptions& options = {});

/// A drawing whose silhouette is a mask (0 or 1 a pixel), painted grey on white.
Drawing drawing_of(const Mask& mask);
/// Mirrored left-right, all rasters.
Drawing mirrored(Drawing drawing);

/// Views that are not aligned by their bounding boxes: every picture as a whole shows the object's box. The masks'
/// sizes must agree on shared axes.
ViewSet views_of_masks(const std::map<View, Mask>& masks);

/// Random silhouettes of a box of `size` pixels: by turns blobs, noise of some density, chequerboards, stripes, thin
/// crossing lines; at least one pixel lit. The same seed gives the same views everywhere.
Mask random_mask(int width, int height, unsigned seed);
std::map<View, Mask> random_masks(const Vec3i& size, unsigned seed, std::span<const View> views = kThreeViews);

}  // namespace carve
