#include "eval/rasterise.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "carve/core/parallel.h"

namespace carve {
namespace {

Vec3 direction(SignedAxis axis) { return axis.sign * Vec3::Unit(axis.axis); }

// Corners in pixels (x right, y down) and depth.
std::vector<Vec3> project(const Mesh& mesh, const CameraAxes& axes, const Window& window) {
  std::vector<Vec3> out(mesh.positions.size());
  parallel_ranges(0, static_cast<int>(out.size()), 4096, [&](int first, int last) {
    for (int i = first; i < last; ++i) {
      const Vec3& p = mesh.positions[i];
      out[i] = {(p.dot(axes.right) - window.right0) / window.right_per_pixel,
                (p.dot(axes.up) - window.up0) / window.up_per_pixel, p.dot(axes.toward)};
    }
  });
  return out;
}

double doubled_area(const Vec3& a, const Vec3& b, double x, double y) {
  return (b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x());
}

// First and one past the last of [0, count) whose centre i + 0.5 lies in [low, high].
std::pair<int, int> centres_between(double low, double high, int begin, int end) {
  return {static_cast<int>(std::ceil(std::clamp(low - 0.5, double(begin), double(end)))),
          static_cast<int>(std::floor(std::clamp(high - 0.5, begin - 1.0, end - 1.0))) + 1};
}

void draw(Seen& seen, int triangle, const Vec3& a, const Vec3& b, const Vec3& c, int y0, int y1) {
  const double whole = doubled_area(a, b, c.x(), c.y());
  if (whole == 0) return;  // edge-on
  const auto [first_y, last_y] =
      centres_between(std::min({a.y(), b.y(), c.y()}), std::max({a.y(), b.y(), c.y()}), y0, y1);
  const auto [first_x, last_x] =
      centres_between(std::min({a.x(), b.x(), c.x()}), std::max({a.x(), b.x(), c.x()}), 0, seen.depth.width);
  for (int y = first_y; y < last_y; ++y)
    for (int x = first_x; x < last_x; ++x) {
      const double u = doubled_area(b, c, x + 0.5, y + 0.5) / whole, v = doubled_area(c, a, x + 0.5, y + 0.5) / whole,
                   w = doubled_area(a, b, x + 0.5, y + 0.5) / whole;
      if (u < 0 || v < 0 || w < 0) continue;
      const double depth = u * a.z() + v * b.z() + w * c.z();
      if (!(depth > seen.depth(x, y))) continue;
      seen.depth(x, y) = depth;
      seen.triangle(x, y) = triangle;
    }
}

}  // namespace

CameraAxes camera(View view) {
  const Frame f = frame(view);
  return {direction(f.right), direction(f.up), direction(f.toward)};
}

CameraAxes camera(double azimuth, double elevation) {
  const double a = azimuth * std::numbers::pi / 180, e = elevation * std::numbers::pi / 180;
  const Vec3 right(std::cos(a), 0, -std::sin(a));
  const Vec3 toward(std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e));
  return {right, toward.cross(right), toward};
}

Seen rasterise(const Mesh& mesh, const CameraAxes& axes, const Window& window) {
  Seen seen{Raster<double>(window.width, window.height, Seen::kNothing), Raster<int>(window.width, window.height, -1)};
  const std::vector<Vec3> corners = project(mesh, axes, window);
  // Every range of rows goes through the triangles in their order, so that equal depths are settled alike.
  parallel_ranges(0, window.height, std::max(16, window.height / 16), [&](int y0, int y1) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto [i, j, k] = mesh.triangles[t];
      const Vec3 &a = corners[i], &b = corners[j], &c = corners[k];
      if (std::max({a.y(), b.y(), c.y()}) < y0 || std::min({a.y(), b.y(), c.y()}) > y1) continue;
      draw(seen, static_cast<int>(t), a, b, c, y0, y1);
    }
  });
  return seen;
}

}  // namespace carve
