#include "carve/texture/atlas.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "carve/core/error.h"
#include "carve/core/options.h"
#include "carve/mesh/neighbours.h"
#include "carve/texture/chart_uvs.h"
#include "carve/texture/packing.h"

namespace carve {
namespace {

double doubled_area(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

struct Extent {
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity()), high = -low;
};

std::vector<Extent> extents(const Charts& charts) {
  std::vector<Extent> all(charts.count);
  for (std::size_t t = 0; t < charts.triangles.size(); ++t)
    for (const int i : charts.triangles[t]) {
      Extent& e = all[charts.chart[t]];
      e.low = e.low.cwiseMin(charts.uvs[i]), e.high = e.high.cwiseMax(charts.uvs[i]);
    }
  return all;
}

// The range of x that a triangle has between two heights; empty (first > second) where it has none.
std::pair<double, double> span_between(const Vec2* corner, double y0, double y1) {
  double x0 = std::numeric_limits<double>::infinity(), x1 = -x0;
  for (int k = 0; k < 3; ++k) {
    const Vec2 &a = corner[k], &b = corner[(k + 1) % 3];
    if (a.y() >= y0 && a.y() <= y1) x0 = std::min(x0, a.x()), x1 = std::max(x1, a.x());
    for (const double y : {y0, y1})
      if ((a.y() < y) != (b.y() < y)) {
        const double x = a.x() + (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y());
        x0 = std::min(x0, x), x1 = std::max(x1, x);
      }
  }
  return {x0, x1};
}

// One attempt to place all charts at one scale.
class Layout {
 public:
  Layout(const Charts& charts, const std::vector<Extent>& extents, const AtlasOptions& options)
      : charts_(charts),
        extents_(extents),
        size_(options.size),
        cell_(std::clamp(options.size / 256, 1, 32)),
        margin_(options.gutter / 2.0 + 0.5) {}

  /// Per chart what moves its scaled coordinates to the texture, whole texels.
  std::optional<std::vector<Vec2>> place(double scale) const {
    const int side = size_ / cell_;
    std::vector<Vec2> base(charts_.count);
    std::vector<Mask> shapes(charts_.count);
    double cells = 0;
    for (int c = 0; c < charts_.count; ++c) {
      const Vec2 low = (scale * extents_[c].low).array() - margin_, high = (scale * extents_[c].high).array() + margin_;
      base[c] = low.array().floor();
      const Vec2 extent = ((high - base[c]) / cell_).array().ceil();
      if (!(extent.maxCoeff() <= side)) return std::nullopt;
      shapes[c] = Mask(static_cast<int>(extent.x()), static_cast<int>(extent.y()));
    }
    for (std::size_t t = 0; t < charts_.triangles.size(); ++t) mark(t, scale, base, shapes);
    for (const Mask& shape : shapes) cells += static_cast<double>(std::ranges::count(shape.pixels, 1));
    if (cells > static_cast<double>(side) * side) return std::nullopt;
    const auto places = pack(shapes, side);
    if (!places) return std::nullopt;
    for (int c = 0; c < charts_.count; ++c) base[c] = Vec2((*places)[c].x, (*places)[c].y) * cell_ - base[c];
    return base;
  }

 private:
  void mark(std::size_t t, double scale, const std::vector<Vec2>& base, std::vector<Mask>& shapes) const {
    const int c = charts_.chart[t];
    Mask& shape = shapes[c];
    Vec2 corner[3];
    for (int k = 0; k < 3; ++k) corner[k] = scale * charts_.uvs[charts_.triangles[t][k]] - base[c];
    const auto cell = [&](double x, int count) { return std::clamp(static_cast<int>(x / cell_), 0, count - 1); };
    const auto [low, high] = std::minmax({corner[0].y(), corner[1].y(), corner[2].y()});
    for (int y = cell(low - margin_, shape.height); y <= cell(high + margin_, shape.height); ++y) {
      const auto [x0, x1] = span_between(corner, y * cell_ - margin_, (y + 1) * cell_ + margin_);
      if (x0 > x1) continue;
      const int first = cell(x0 - margin_, shape.width), last = cell(x1 + margin_, shape.width);
      std::fill(&shape(first, y), &shape(first, y) + (last - first + 1), std::uint8_t{1});
    }
  }

  const Charts& charts_;
  const std::vector<Extent>& extents_;
  int size_, cell_;
  double margin_;
};

// Scales the charts and moves them to their places.
Atlas packed(Charts charts, const AtlasOptions& options) {
  const std::vector<Extent> extents = carve::extents(charts);
  double area = 0, longest = 0;
  for (const Triangle& t : charts.triangles)
    area += std::abs(doubled_area(charts.uvs[t[0]], charts.uvs[t[1]], charts.uvs[t[2]])) / 2;
  for (const Extent& e : extents) longest = std::max(longest, (e.high - e.low).maxCoeff());
  const Layout layout(charts, extents, options);
  double scale =
      std::min(options.size * std::sqrt(0.9 / std::max(area, 1e-12)), options.size / std::max(longest, 1e-12));
  constexpr int kAttempts = 120;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (options.exact && scale >= 1) scale = std::floor(scale);
    if (const auto shift = layout.place(scale)) {
      std::vector<char> moved(charts.uvs.size());
      for (std::size_t t = 0; t < charts.triangles.size(); ++t)
        for (const int i : charts.triangles[t])
          if (!std::exchange(moved[i], 1)) charts.uvs[i] = scale * charts.uvs[i] + (*shift)[charts.chart[t]];
      return {options.size, scale, std::move(charts), {}};
    }
    scale = options.exact && scale > 1 ? scale - 1 : scale * 0.95;
  }
  throw NoResult("atlas.size must be larger: " + std::to_string(charts.count) + " charts " +
                 std::to_string(options.gutter) + " texels apart do not fit into " + std::to_string(options.size) +
                 " x " + std::to_string(options.size));
}

// Gives every texel to the first triangle its centre lies in; `clash(a, b)` is told of texels well inside two.
template <class Clash>
void find_owners(Atlas& atlas, const Clash& clash) {
  constexpr double kInside = 1e-6;
  const Charts& charts = atlas.charts;
  const auto weights = [&](int t, double x, double y) -> Vec3 {
    const auto& [i, j, k] = charts.triangles[t];
    const Vec2 p(x + 0.5, y + 0.5), &a = charts.uvs[i], &b = charts.uvs[j], &c = charts.uvs[k];
    const double area = doubled_area(a, b, c);
    return Vec3(doubled_area(b, c, p), doubled_area(c, a, p), doubled_area(a, b, p)) / area;
  };
  atlas.owner = Raster<int>(atlas.size, atlas.size, -1);
  std::vector<int> without;
  for (int t = 0; t < static_cast<int>(charts.triangles.size()); ++t) {
    const auto& [i, j, k] = charts.triangles[t];
    const Vec2 &a = charts.uvs[i], &b = charts.uvs[j], &c = charts.uvs[k];
    if (doubled_area(a, b, c) == 0) continue;
    bool owns = false;
    const Vec2 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    for (int y = static_cast<int>(std::ceil(low.y() - 0.5)); y <= static_cast<int>(high.y() - 0.5); ++y)
      for (int x = static_cast<int>(std::ceil(low.x() - 0.5)); x <= static_cast<int>(high.x() - 0.5); ++x) {
        const double inside = weights(t, x, y).minCoeff();
        if (inside < 0) continue;
        int& owner = atlas.owner(x, y);
        if (owner < 0) owner = t;
        owns |= owner == t;
        if (owner != t && inside > kInside && weights(owner, x, y).minCoeff() > kInside) clash(owner, t);
      }
    if (!owns) without.push_back(t);
  }
  // A triangle between the centres takes the texel it lies in, if that is free.
  for (const int t : without) {
    const auto& [i, j, k] = charts.triangles[t];
    const Vec2 centre = (charts.uvs[i] + charts.uvs[j] + charts.uvs[k]) / 3;
    int& owner = atlas.owner(static_cast<int>(centre.x()), static_cast<int>(centre.y()));
    if (owner < 0) owner = t;
  }
}

// Takes the marked triangles out of their charts. What hangs together of them, and of what is left, makes a chart
// each. Coordinates stay.
void split_off(const Mesh& mesh, const std::vector<char>& marked, Charts& charts) {
  const auto neighbours = triangle_neighbours(mesh);
  const std::vector<int> before = charts.chart;
  std::ranges::fill(charts.chart, -1);
  charts.count = 0;
  std::vector<int> open;
  for (int t = 0; t < static_cast<int>(marked.size()); ++t) {
    if (charts.chart[t] >= 0) continue;
    open.assign(1, t);
    charts.chart[t] = charts.count;
    while (!open.empty()) {
      const int here = open.back();
      open.pop_back();
      for (const int next : neighbours[here])
        if (next >= 0 && charts.chart[next] < 0 && before[next] == before[here] && marked[next] == marked[here]) {
          charts.chart[next] = charts.count;
          open.push_back(next);
        }
    }
    ++charts.count;
  }
  const Charts old = charts;
  share_corners(mesh, charts, [&](int t, int v) {
    const Triangle& corners = mesh.triangles[t];
    return old.uvs[old.triangles[t][corners[0] == v ? 0 : corners[1] == v ? 1 : 2]];
  });
}

}  // namespace

Atlas lay_out(const Mesh& mesh, Charts charts, const AtlasOptions& options) {
  check("atlas", options);
  for (;;) {
    Atlas atlas = packed(charts, options);
    std::vector<char> marked(mesh.triangles.size());
    bool overlap = false;
    find_owners(atlas, [&](int a, int b) {
      overlap = true;
      const bool first = !charts.height.empty() && charts.height[a] < charts.height[b];
      marked[first ? a : b] = 1;
    });
    if (!overlap) return atlas;
    split_off(mesh, marked, charts);
  }
}

}  // namespace carve
