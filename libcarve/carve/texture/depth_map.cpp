#include "carve/texture/depth_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace carve {
namespace {
constexpr float kNone = std::numeric_limits<float>::infinity();
}

DepthMap::DepthMap(const Mesh& mesh, const AlignedView& view) {
  const Frame f = frame(view.view);
  toward_ = f.toward, right_ = f.right.axis, up_ = f.up.axis;
  // The box of the drawing and a rim for what stands out from it.
  const Box& box = view.drawing.bounds;
  double scale = 1;
  while (std::max(box.width(), box.height()) * scale > kLargestSide) scale /= 2;
  constexpr int kRim = 2;
  column_per_unit_ = view.column_per_unit * scale, row_per_unit_ = view.row_per_unit * scale;
  column0_ = (view.column0 - box.x0) * scale + kRim, row0_ = (view.row0 - box.y0) * scale + kRim;
  pixel_ = 1 / std::min(std::abs(column_per_unit_), std::abs(row_per_unit_));
  ranges_ = Raster<Range>(static_cast<int>(std::ceil(box.width() * scale)) + 2 * kRim,
                          static_cast<int>(std::ceil(box.height() * scale)) + 2 * kRim, {-kNone, kNone});
  for (const auto& [a, b, c] : mesh.triangles) draw(mesh.positions[a], mesh.positions[b], mesh.positions[c]);
}

Vec2 DepthMap::place(const Vec3& point) const {
  return {column0_ + column_per_unit_ * point[right_], row0_ + row_per_unit_ * point[up_]};
}

DepthMap::Range DepthMap::at(const Vec3& point) const {
  const Vec2 place = this->place(point);
  const int x = static_cast<int>(std::clamp(place.x(), 0.0, ranges_.width - 1.0));
  const int y = static_cast<int>(std::clamp(place.y(), 0.0, ranges_.height - 1.0));
  return ranges_(x, y);
}

void DepthMap::draw(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec2 p = place(a), q = place(b), r = place(c);
  const Vec2 u = q - p, v = r - p;
  const double area = u.x() * v.y() - u.y() * v.x();
  if (area == 0) return;  // edge-on
  // Pixels whose centres lie inside.
  const auto first = [](double low, int size) {
    return static_cast<int>(std::ceil(std::clamp(low - 0.5, 0.0, double(size))));
  };
  const auto last = [](double high, int size) {
    return static_cast<int>(std::floor(std::clamp(high - 0.5, -1.0, size - 1.0)));
  };
  const int y0 = first(std::min({p.y(), q.y(), r.y()}), ranges_.height);
  const int y1 = last(std::max({p.y(), q.y(), r.y()}), ranges_.height);
  const int x0 = first(std::min({p.x(), q.x(), r.x()}), ranges_.width);
  const int x1 = last(std::max({p.x(), q.x(), r.x()}), ranges_.width);
  const double at_a = depth(a), to_b = depth(b) - at_a, to_c = depth(c) - at_a;
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const double dx = x + 0.5 - p.x(), dy = y + 0.5 - p.y();
      const double s = (dx * v.y() - dy * v.x()) / area, t = (u.x() * dy - u.y() * dx) / area;
      if (s < 0 || t < 0 || s + t > 1) continue;
      const auto depth = static_cast<float>(at_a + s * to_b + t * to_c);
      Range& range = ranges_(x, y);
      range.nearest = std::max(range.nearest, depth);
      range.farthest = std::min(range.farthest, depth);
    }
}

}  // namespace carve
