#include "eval/heat_map.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>

#include "carve/core/options.h"
#include "eval/compare.h"
#include "eval/shade.h"
#include "eval/text.h"

namespace carve {
namespace {

constexpr double kTextSize = 15;
constexpr int kMargin = 14, kBarWidth = 18, kBarSpace = 120, kHead = 44, kLabel = 20;
constexpr Rgba kWhite{255, 255, 255, 255}, kGrey{110, 110, 110, 255};

std::string rounded(const char* format, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

// The distance at the point of triangle t that a camera sees at (right, up): linear between the corners.
double distance_at(const HeatMap& map, int t, const CameraAxes& axes, double right, double up) {
  const auto [a, b, c] = map.mesh.triangles[t];
  const auto seen = [&](int i) {
    return Vec2(map.mesh.positions[i].dot(axes.right), map.mesh.positions[i].dot(axes.up));
  };
  const Vec2 p(right, up), pa = seen(a), pb = seen(b), pc = seen(c);
  const auto area = [](const Vec2& u, const Vec2& v) { return u.x() * v.y() - u.y() * v.x(); };
  const double whole = area(pb - pa, pc - pa);
  const double u = area(pb - p, pc - p) / whole, v = area(pc - p, pa - p) / whole;
  return u * map.distances[a] + v * map.distances[b] + (1 - u - v) * map.distances[c];
}

// Grey without distances.
Picture draw_panel(const HeatMap& map, const CameraAxes& axes, const Window& window, Ramp ramp, double range) {
  return shade(map.mesh, axes, window, [&](int t, double right, double up) {
    return map.distances.empty() ? kClay : colour(ramp, distance_at(map, t, axes, right, up), range);
  });
}

void draw_bar(Picture& figure, int x0, int y0, int height, Ramp ramp, double range, double diagonal) {
  const double low = is_signed(ramp) ? -range : 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < kBarWidth; ++x)
      figure(x0 + x, y0 + y) = colour(ramp, range + (low - range) * (y + 0.5) / height, range);
  draw_text(figure, x0, y0 - 26, kTextSize - 2, is_signed(ramp) ? "signed distance" : "distance");
  draw_text(figure, x0, y0 - 10, kTextSize - 2, "% of diagonal");
  constexpr int kTicks = 4;
  for (int i = 0; i <= kTicks; ++i) {
    const double value = range + (low - range) * i / kTicks;
    const int y = y0 + static_cast<int>(std::lround(static_cast<double>(height) * i / kTicks));
    for (int x = 0; x < 5; ++x) figure(x0 + kBarWidth + x, std::min(y, y0 + height - 1)) = kGrey;
    draw_text(figure, x0 + kBarWidth + 9, y + 5, kTextSize - 2,
              rounded(is_signed(ramp) && value != 0 ? "%+.3g" : "%.3g", 100 * value / diagonal));
  }
}

std::string summary(const HeatMap& map, double range, double diagonal) {
  if (map.distances.empty()) return "";
  std::vector<double> lengths(map.distances.size());
  std::transform(map.distances.begin(), map.distances.end(), lengths.begin(), [](double d) { return std::abs(d); });
  const Distances d = summarise(std::move(lengths));
  return "mean " + rounded("%.3g", 100 * d.mean / diagonal) + " %, max " + rounded("%.3g", 100 * d.max / diagonal) +
         " %, beyond the bar " + rounded("%.3g", 100 * saturated_share(map, range)) + " %";
}

// Panels in a grid: line[row][column], every column as wide as its widest panel and title.
class Figure {
 public:
  Figure(const std::vector<HeatMap>& maps, const Mesh& reference, double diagonal, const HeatMapOptions& options)
      : options_(options), diagonal_(diagonal), range_(heat_range(maps, diagonal, options)) {
    const HeatMap grey{"reference", reference, {}};
    std::vector<const HeatMap*> columns;
    if (options.show_reference) columns.push_back(&grey);
    for (const HeatMap& map : maps) columns.push_back(&map);
    across_ = columns.size() == 1;
    const std::vector<Vec3> corners = all_corners(columns, reference);
    Vec3 low = corners[0], high = corners[0];
    for (const Vec3& corner : corners) low = low.cwiseMin(corner), high = high.cwiseMax(corner);
    const double longest = (high - low).maxCoeff();
    for (const HeatMap* map : columns) {
      titles_.push_back({map->title, summary(*map, range_, diagonal)});
      for (const std::string& view : options.views) {
        const CameraAxes axes = named_camera(view);
        panels_.push_back(
            draw_panel(*map, axes, window_around(axes, corners, options.size / longest), options.ramp, range_));
      }
    }
    rows_ = across_ ? 1 : static_cast<int>(options.views.size());
    columns_ = across_ ? static_cast<int>(options.views.size()) : static_cast<int>(columns.size());
  }

  Picture compose() const {
    std::vector<int> widths(columns_, 0), heights(rows_, 0);
    for (int r = 0; r < rows_; ++r)
      for (int c = 0; c < columns_; ++c) {
        widths[c] = std::max(widths[c], panel(r, c).width);
        heights[r] = std::max(heights[r], panel(r, c).height);
      }
    if (!across_)
      for (int c = 0; c < columns_; ++c) widths[c] = std::max(widths[c], title_width(c));
    const int inner = std::accumulate(widths.begin(), widths.end(), (columns_ - 1) * kMargin);
    const int width = kMargin + std::max(inner, across_ ? title_width(0) : 0) + 2 * kMargin + kBarSpace;
    const int height = kMargin + kHead + std::accumulate(heights.begin(), heights.end(), rows_ * (kLabel + kMargin));
    Picture figure(width, std::max(height, 220), kWhite);
    int y = kMargin + kHead;
    for (int r = 0; r < rows_; y += heights[r++] + kLabel + kMargin) {
      int x = kMargin;
      for (int c = 0; c < columns_; x += widths[c++] + kMargin) {
        const Picture& picture = panel(r, c);
        paste(figure, picture, x + (widths[c] - picture.width) / 2, y + (heights[r] - picture.height) / 2);
        draw_text(figure, x + widths[c] / 2.0, y + heights[r] + kLabel - 4, kTextSize - 2,
                  options_.views[across_ ? c : r], Align::centre, kGrey);
        if (r == 0 && (!across_ || c == 0)) draw_title(figure, x, c);
      }
    }
    const int bar_height = std::clamp(figure.height - kHead - 3 * kMargin, 100, 320);
    draw_bar(figure, figure.width - kMargin - kBarSpace + 10, kHead + kMargin, bar_height, options_.ramp, range_,
             diagonal_);
    return figure;
  }

 private:
  static std::vector<Vec3> all_corners(const std::vector<const HeatMap*>& maps, const Mesh& reference) {
    std::vector<Vec3> corners;
    const auto add = [&](const Mesh& mesh) {
      for (const Triangle& triangle : mesh.triangles)
        for (const int corner : triangle) corners.push_back(mesh.positions[corner]);
    };
    add(reference);
    for (const HeatMap* map : maps) add(map->mesh);
    return corners;
  }

  const Picture& panel(int row, int column) const {
    return across_ ? panels_[column] : panels_[column * options_.views.size() + row];
  }
  int title_width(int column) const {
    const auto& [title, figures] = titles_[column];
    return static_cast<int>(std::ceil(std::max(text_width(kTextSize, title), text_width(kTextSize - 3, figures))));
  }
  void draw_title(Picture& figure, int x, int column) const {
    draw_text(figure, x, kMargin + 8, kTextSize, titles_[column].first);
    draw_text(figure, x, kMargin + 26, kTextSize - 3, titles_[column].second, Align::left, kGrey);
  }

  const HeatMapOptions& options_;
  double diagonal_, range_;
  bool across_ = false;  // one mesh: its views stand side by side
  int rows_ = 0, columns_ = 0;
  std::vector<std::pair<std::string, std::string>> titles_;
  std::vector<Picture> panels_;  // mesh by mesh
};

}  // namespace

Mesh with_short_edges(const Mesh& mesh, double longest) {
  Mesh out = mesh;
  for (bool any = true; any;) {
    any = false;
    std::map<std::pair<int, int>, int> middles;  // of long edges: both of their triangles find the same
    std::vector<Triangle> finer;
    const auto is_long = [&](int a, int b) { return (out.positions[a] - out.positions[b]).norm() > longest; };
    const auto middle = [&](int a, int b) {
      const auto [entry, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<int>(out.positions.size()));
      if (is_new) out.positions.push_back((out.positions[a] + out.positions[b]) / 2);
      return entry->second;
    };
    for (Triangle t : out.triangles) {
      const int count = is_long(t[0], t[1]) + is_long(t[1], t[2]) + is_long(t[2], t[0]);
      any = any || count > 0;
      // Turned so that a single long edge is the first, a single short one the last.
      for (int k = 0; k < 2 && (count == 1 ? !is_long(t[0], t[1]) : count == 2 && is_long(t[2], t[0])); ++k)
        t = {t[1], t[2], t[0]};
      if (count == 0) {
        finer.push_back(t);
        continue;
      }
      const int m = middle(t[0], t[1]);
      if (count == 1) {
        finer.insert(finer.end(), {{t[0], m, t[2]}, {m, t[1], t[2]}});
        continue;
      }
      const int n = middle(t[1], t[2]);
      finer.push_back({m, t[1], n});
      if (count == 2) {
        finer.insert(finer.end(), {{t[0], m, n}, {t[0], n, t[2]}});
        continue;
      }
      const int o = middle(t[2], t[0]);
      finer.insert(finer.end(), {{t[0], m, o}, {o, n, t[2]}, {m, n, o}});
    }
    out.triangles = std::move(finer);
  }
  return out;
}

double heat_range(const std::vector<HeatMap>& maps, double diagonal, const HeatMapOptions& options) {
  if (options.range) return *options.range / 100 * diagonal;
  std::vector<double> all;
  for (const HeatMap& map : maps)
    for (const double d : map.distances) all.push_back(std::abs(d));
  const double percent = 100 * summarise(std::move(all)).percentile(99) / diagonal;
  if (!(percent > 1e-9)) return 1e-9 / 100 * diagonal;
  const double power = std::pow(10, std::floor(std::log10(percent)));
  for (const double step : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0})
    if (percent <= step * power * (1 + 1e-12)) return step * power / 100 * diagonal;
  return power * diagonal;
}

double saturated_share(const HeatMap& map, double range) {
  const auto beyond =
      std::count_if(map.distances.begin(), map.distances.end(), [range](double d) { return std::abs(d) > range; });
  return map.distances.empty() ? 0 : static_cast<double>(beyond) / static_cast<double>(map.distances.size());
}

Picture draw_heat_maps(const std::vector<HeatMap>& maps, const Mesh& reference, double diagonal,
                       const HeatMapOptions& options) {
  check("", options);
  if (maps.empty()) throw std::invalid_argument("a heat map needs at least one compared mesh");
  if (options.views.empty()) throw std::invalid_argument("views must name at least one view, got none");
  for (const HeatMap& map : maps)
    if (map.mesh.triangles.empty())
      throw std::invalid_argument("a picture needs triangles; write a cloud as .ply or .vtp");
  return Figure(maps, reference, diagonal, options).compose();
}

}  // namespace carve
