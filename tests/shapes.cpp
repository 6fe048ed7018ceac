#include "shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace carve {
namespace {

constexpr double kPi = std::numbers::pi;

/// The object's extent along an image axis, in that axis's coordinate.
struct Extent {
  double low, size;
};
Extent extent(const Vec3& size, SignedAxis axis) {
  const double low = axis.axis == 1 ? 0 : -size[axis.axis] / 2;
  return {axis.sign > 0 ? low : -(low + size[axis.axis]), size[axis.axis]};
}

/// A disc's chord at height b, or nothing.
Spans chord(double radius, double centre_b, double b) {
  const double square = radius * radius - (b - centre_b) * (b - centre_b);
  if (square <= 0) return {};
  return {{-std::sqrt(square), std::sqrt(square)}};
}

/// Stairs seen from the side: at height y the solid reaches from the back (z = -1/2) to the first step of that height.
double stairs_front(int steps, double y) { return 0.5 - std::floor(y * steps) / steps; }

std::vector<Stroke> step_strokes(int steps, View view, double half_width) {
  std::vector<Stroke> strokes;
  for (int k = 1; k < steps; ++k) {
    const double at = static_cast<double>(k) / steps;
    if (view == View::front) strokes.push_back({{-half_width, at}, {half_width, at}});
    if (view == View::top) strokes.push_back({{-half_width, at - 0.5}, {half_width, at - 0.5}});
  }
  return strokes;
}

double distance(const Vec2& p, const Stroke& stroke) {
  const Vec2 along = stroke.to - stroke.from;
  const double t = std::clamp((p - stroke.from).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - stroke.from - t * along).norm();
}

void finish(Drawing& drawing) {
  const Raster<Label>& labels = drawing.labels;
  drawing.picture = Picture(labels.width, labels.height, {255, 255, 255, 255});
  drawing.background = Background::border;
  drawing.border = {255, 255, 255, 255};
  Box box{labels.width, labels.height, 0, 0};
  for (int y = 0; y < labels.height; ++y)
    for (int x = 0; x < labels.width; ++x) {
      const auto shade = static_cast<std::uint8_t>(255 - drawing.coverage(x, y) / 2);
      drawing.picture(x, y) = {shade, shade, shade, 255};
      if (labels(x, y) == Label::edge) drawing.picture(x, y) = {0, 0, 0, 255};
      if (labels(x, y) == Label::background) continue;
      box = {std::min(box.x0, x), std::min(box.y0, y), std::max(box.x1, x + 1), std::max(box.y1, y + 1)};
    }
  drawing.bounds = box.x0 < box.x1 ? box : Box{};
}

}  // namespace

Shape box(const Vec3& size) {
  const double volume = size.prod();
  return {"box",
          size,
          volume,
          volume,
          [size](const Vec3& p) {
            return std::abs(p.x()) < size.x() / 2 && p.y() > 0 && p.y() < size.y() && std::abs(p.z()) < size.z() / 2;
          },
          [size](View view, double) {
            const double half = size[frame(view).right.axis] / 2;
            return Spans{{-half, half}};
          }};
}

Shape ball() {
  // The hull of three discs is the tricylinder, 8 (2 - sqrt 2) r^3.
  return {"ball",
          Vec3::Ones(),
          kPi / 6,
          2 - std::sqrt(2.0),
          [](const Vec3& p) { return (p - Vec3(0, 0.5, 0)).norm() < 0.5; },
          [](View view, double b) { return chord(0.5, frame(view).up.axis == 1 ? 0.5 : 0, b); }};
}

Shape torus(double tube) {
  const double radius = 0.5 - tube;
  // Front and side are one stadium: at height y the hull is the square they leave, cut by the ring seen from above.
  // Over heights, with half width w = radius + sqrt(tube^2 - y^2) in [radius, 1/2]: the disc of radius 1/2 within the
  // square of half width w, less the hole.
  const auto section = [=](double w) {
    if (8 * w * w <= 1) return 4 * w * w - kPi * (radius - tube) * (radius - tube);
    const double cap = 0.25 * std::acos(2 * w) - w * std::sqrt(0.25 - w * w);
    return kPi * 0.25 - 4 * cap - kPi * (radius - tube) * (radius - tube);
  };
  double hull = 0;
  constexpr int slices = 20000;
  for (int i = 0; i < slices; ++i) {
    const double y = tube * (2 * (i + 0.5) / slices - 1);
    hull += section(std::min(0.5, radius + std::sqrt(tube * tube - y * y))) * 2 * tube / slices;
  }
  return {"torus",
          {1, 2 * tube, 1},
          2 * kPi * kPi * radius * tube * tube,
          hull,
          [=](const Vec3& p) { return std::hypot(std::hypot(p.x(), p.z()) - radius, p.y() - tube) < tube; },
          [=](View view, double b) {
            if (frame(view).up.axis == 1) {
              Spans spans = chord(tube, tube, b);
              for (auto& [from, to] : spans) from -= radius, to += radius;
              return spans;
            }
            const Spans disc = chord(0.5, 0, b), hole = chord(radius - tube, 0, b);
            if (disc.empty() || hole.empty()) return disc;
            return Spans{{disc[0].first, hole[0].first}, {hole[0].second, disc[0].second}};
          }};
}

Shape stairs(int steps) {
  const double volume = (steps + 1) / (2.0 * steps);
  return {"stairs",
          Vec3::Ones(),
          volume,
          volume,
          [=](const Vec3& p) {
            return std::abs(p.x()) < 0.5 && p.y() > 0 && p.y() < 1 && p.z() > -0.5 &&
                   p.z() < stairs_front(steps, p.y());
          },
          [=](View view, double b) -> Spans {
            if (frame(view).toward.axis != 0) return {{-0.5, 0.5}};
            const double front = stairs_front(steps, b);
            return view == View::side ? Spans{{-front, 0.5}} : Spans{{-0.5, front}};
          },
          [=](View view) { return step_strokes(steps, view, 0.5); }};
}

Shape walled_stairs(int steps) {
  constexpr double inner = 0.375;  // half the distance between the walls
  Shape shape = stairs(steps);
  shape.name = "walled_stairs";
  shape.volume = 2 * inner * shape.volume + (1 - 2 * inner);
  shape.hull_volume = 1;
  shape.inside = [stairs = shape.inside](const Vec3& p) {
    const bool in_box = std::abs(p.x()) < 0.5 && p.y() > 0 && p.y() < 1 && std::abs(p.z()) < 0.5;
    return in_box && (std::abs(p.x()) > inner || stairs(p));
  };
  shape.spans = [](View, double) { return Spans{{-0.5, 0.5}}; };
  shape.strokes = [=](View view) {
    if (view != View::front && view != View::top) return std::vector<Stroke>();
    std::vector<Stroke> strokes = step_strokes(steps, view, inner);
    const double low = view == View::front ? 0 : -0.5;
    for (double x : {-inner, inner}) strokes.push_back({{x, low}, {x, low + 1}});
    return strokes;
  };
  return shape;
}

std::vector<Shape> all_shapes() { return {box(), ball(), torus(), stairs(), walled_stairs()}; }

Drawing draw(const Shape& shape, View view, const DrawOptions& options) {
  constexpr int lines = 64;
  const Extent right = extent(shape.size, frame(view).right), up = extent(shape.size, frame(view).up);
  const int width = static_cast<int>(std::ceil(right.size * options.pixels - 1e-9)) + 2 * options.margin;
  const int height = static_cast<int>(std::ceil(up.size * options.pixels - 1e-9)) + 2 * options.margin;
  // The box starts at a pixel's corner on the left and at the bottom.
  const auto column = [&](double a) { return options.margin + (a - right.low) * options.pixels; };
  const auto row = [&](double b) { return height - options.margin - (b - up.low) * options.pixels; };

  Drawing drawing;
  drawing.labels = Raster<Label>(width, height);
  drawing.coverage = Mask(width, height);
  const std::vector<Stroke> strokes = options.stroke > 0 ? shape.strokes(view) : std::vector<Stroke>();
  std::vector<double> covered(width);
  for (int y = 0; y < height; ++y) {
    std::ranges::fill(covered, 0);
    for (int line = 0; line < lines; ++line) {
      const double b = up.low + (height - options.margin - (y + (line + 0.5) / lines)) / options.pixels;
      if (b <= up.low || b >= up.low + up.size) continue;
      for (const auto& [from, to] : shape.spans(view, b))
        for (int x = std::max(0, static_cast<int>(column(from))); x < width && x < column(to); ++x)
          covered[x] += std::max(0.0, std::min<double>(x + 1, column(to)) - std::max<double>(x, column(from))) / lines;
    }
    for (int x = 0; x < width; ++x) {
      drawing.coverage(x, y) = static_cast<std::uint8_t>(std::lround(255 * std::min(1.0, covered[x])));
      if (drawing.coverage(x, y) < 128) continue;
      drawing.labels(x, y) = Label::surface;
      for (const Stroke& stroke : strokes) {
        const Stroke drawn{{column(stroke.from.x()), row(stroke.from.y())},
                           {column(stroke.to.x()), row(stroke.to.y())}};
        if (distance({x + 0.5, y + 0.5}, drawn) <= options.stroke / 2) drawing.labels(x, y) = Label::edge;
      }
    }
  }
  drawing.max_stroke = std::max(3.0, options.stroke);
  finish(drawing);
  return drawing;
}

std::map<View, Drawing> draw(const Shape& shape, std::span<const View> views, const DrawOptions& options) {
  std::map<View, Drawing> drawings;
  for (View view : views) drawings.emplace(view, draw(shape, view, options));
  return drawings;
}

ViewSet aligned(const Shape& shape, std::span<const View> views, const DrawOptions& options) {
  return align(draw(shape, views, options));
}

Drawing drawing_of(const Mask& mask) {
  Drawing drawing;
  drawing.labels = Raster<Label>(mask.width, mask.height);
  drawing.coverage = Mask(mask.width, mask.height);
  for (std::size_t i = 0; i < mask.pixels.size(); ++i)
    if (mask.pixels[i]) drawing.labels.pixels[i] = Label::surface, drawing.coverage.pixels[i] = 255;
  drawing.max_stroke = 3;
  finish(drawing);
  return drawing;
}

Drawing mirrored(Drawing drawing) {
  const auto mirror = [](auto& raster) {
    for (int y = 0; y < raster.height; ++y) std::reverse(&raster(0, y), &raster(0, y) + raster.width);
  };
  mirror(drawing.picture);
  mirror(drawing.labels);
  mirror(drawing.coverage);
  const Box& box = drawing.bounds;
  drawing.bounds = {drawing.labels.width - box.x1, box.y0, drawing.labels.width - box.x0, box.y1};
  return drawing;
}

ViewSet views_of_masks(const std::map<View, Mask>& masks) {
  std::map<View, Drawing> drawings;
  for (const auto& [view, mask] : masks) {
    drawings[view] = drawing_of(mask);
    drawings[view].bounds = {0, 0, mask.width, mask.height};
  }
  return align(std::move(drawings));
}

Mask random_mask(int width, int height, unsigned seed) {
  std::mt19937 generator(seed);
  const auto below = [&](int n) { return static_cast<int>(generator() % static_cast<unsigned>(n)); };
  Mask mask(width, height);
  const auto each = [&](auto&& value) {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) mask(x, y) = value(x, y);
  };
  switch (below(5)) {
    case 0:
      for (int blob = 1 + below(5); blob > 0; --blob) {
        const int cx = below(width), cy = below(height), r = 1 + below(std::max(2, std::max(width, height) / 2));
        each([&](int x, int y) { return mask(x, y) || (x - cx) * (x - cx) + (y - cy) * (y - cy) < r * r; });
      }
      break;
    case 1: {
      const int density = 1 + below(9);
      each([&](int, int) { return below(10) < density; });
      break;
    }
    case 2: {
      const int cell = 1 + below(3);
      each([&](int x, int y) { return (x / cell + y / cell) % 2 == 0; });
      break;
    }
    case 3: {
      const int period = 2 + below(4), slope = below(3) - 1;
      each([&](int x, int y) { return (x + slope * y + period * height) % period < (period + 1) / 2; });
      break;
    }
    default:
      for (int line = 1 + below(4); line > 0; --line) {
        const int cx = below(width), cy = below(height);
        each([&](int x, int y) { return mask(x, y) || x == cx || y == cy || x - cx == y - cy; });
      }
  }
  mask(below(width), below(height)) = 1;
  return mask;
}

std::map<View, Mask> random_masks(const Vec3i& size, unsigned seed, std::span<const View> views) {
  std::map<View, Mask> masks;
  for (View view : views)
    masks[view] = random_mask(size[frame(view).right.axis], size[frame(view).up.axis],
                              seed * 7919u + static_cast<unsigned>(view));
  return masks;
}

}  // namespace carve
