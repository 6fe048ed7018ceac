#include "image/sketch.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace carve {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

Shape round(Vec2 centre, Rgba colour, int corners, const auto& radius) {
  Shape shape{{}, colour};
  for (int i = 0; i < corners; ++i) {
    const double angle = kTurn * i / corners;
    shape.points.push_back(centre + radius(i, angle) * Vec2(std::cos(angle), std::sin(angle)));
  }
  return shape;
}

int clamped(double value, int size) { return std::clamp(static_cast<int>(std::floor(value)), 0, size); }

// The sub-pixels whose centre lies inside, row by row between the crossings of the polygon's sides.
void fill(const std::vector<Vec2>& points, Rgba colour, Picture& plane) {
  std::vector<double> crossings;
  for (int y = 0; y < plane.height; ++y) {
    const double row = y + 0.5;
    crossings.clear();
    for (std::size_t i = 0, j = points.size() - 1; i < points.size(); j = i++) {
      const Vec2 &a = points[i], &b = points[j];
      if ((a.y() > row) != (b.y() > row))
        crossings.push_back(a.x() + (b.x() - a.x()) * (row - a.y()) / (b.y() - a.y()));
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
      for (int x = clamped(crossings[i] + 0.5, plane.width); x < clamped(crossings[i + 1] + 0.5, plane.width); ++x)
        plane(x, y) = colour;
  }
}

// The sub-pixels whose centre is nearer than `radius` to the segment.
void sweep(const Vec2& a, const Vec2& b, double radius, Rgba colour, Picture& plane) {
  const Vec2 low = a.cwiseMin(b).array() - radius, high = a.cwiseMax(b).array() + radius + 1;
  const Vec2 along = b - a;
  for (int y = clamped(low.y(), plane.height); y < clamped(high.y(), plane.height); ++y)
    for (int x = clamped(low.x(), plane.width); x < clamped(high.x(), plane.width); ++x) {
      const Vec2 p = Vec2(x + 0.5, y + 0.5) - a;
      const double t = std::clamp(p.dot(along) / std::max(along.squaredNorm(), 1e-12), 0.0, 1.0);
      if ((p - t * along).squaredNorm() < radius * radius) plane(x, y) = colour;
    }
}

void paint(Shape shape, int samples, Picture& plane) {
  for (Vec2& p : shape.points) p *= samples;
  if (shape.stroke == 0) return fill(shape.points, shape.colour, plane);
  for (std::size_t i = 0, j = shape.points.size() - 1; i < shape.points.size(); j = i++)
    sweep(shape.points[j], shape.points[i], shape.stroke * samples / 2, shape.colour, plane);
}

}  // namespace

Shape polygon(std::vector<Vec2> points, Rgba colour) { return {std::move(points), colour}; }

Shape rectangle(double x0, double y0, double x1, double y1, Rgba colour) {
  return polygon({{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, colour);
}

Shape disc(Vec2 centre, double radius, Rgba colour) {
  return round(centre, colour, 64, [&](int, double) { return radius; });
}

Shape line(Vec2 from, Vec2 to, double width, Rgba colour) { return {{from, to}, colour, width}; }

Shape outline(Shape shape, double width, Rgba colour) {
  shape.stroke = width;
  shape.colour = colour;
  return shape;
}

Shape blob(Vec2 centre, double radius, Rgba colour, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<double> phase;
  for (int i = 0; i < 4; ++i) phase.push_back(kTurn * (random() % 1000) / 1000);
  return round(centre, colour, 90, [&](int, double angle) {
    double wave = 0;
    for (int i = 0; i < 4; ++i) wave += std::sin((i + 1) * angle + phase[i]) / 4;
    return radius * (0.8 + 0.2 * wave);
  });
}

Shape star(Vec2 centre, double radius, int corners, Rgba colour, unsigned seed) {
  std::mt19937 random(seed);
  return round(centre, colour, corners, [&](int i, double) {
    return radius * (i % 2 ? 0.4 + 0.2 * (random() % 100) / 100 : 0.8 + 0.2 * (random() % 100) / 100);
  });
}

Picture drawn(const Sketch& sketch, int width, int height, int samples) {
  Picture plane(width * samples, height * samples, Rgba{0, 0, 0, 0});
  for (const Shape& shape : sketch) paint(shape, samples, plane);
  Picture picture(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      int sum[4] = {};
      for (int v = 0; v < samples; ++v)
        for (int u = 0; u < samples; ++u) {
          const Rgba p = plane(x * samples + u, y * samples + v);
          if (p.a == 0) continue;
          sum[0] += p.r, sum[1] += p.g, sum[2] += p.b, ++sum[3];
        }
      const auto mean = [&](int c) { return static_cast<std::uint8_t>(sum[3] ? sum[c] / sum[3] : 0); };
      picture(x, y) = {mean(0), mean(1), mean(2), static_cast<std::uint8_t>(sum[3] * 255 / (samples * samples))};
    }
  return picture;
}

Picture on_paper(const Picture& picture, Rgba paper) {
  Picture out = picture;
  for (Rgba& p : out.pixels) {
    const auto mix = [&](int above, int below) {
      return static_cast<std::uint8_t>((above * p.a + below * (255 - p.a) + 127) / 255);
    };
    p = {mix(p.r, paper.r), mix(p.g, paper.g), mix(p.b, paper.b), 255};
  }
  return out;
}

Sketch scaled(Sketch sketch, double factor) {
  for (Shape& shape : sketch) {
    for (Vec2& p : shape.points) p *= factor;
    shape.stroke *= factor;
  }
  return sketch;
}

}  // namespace carve
