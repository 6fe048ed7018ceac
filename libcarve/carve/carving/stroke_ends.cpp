#include "carve/carving/stroke_ends.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "carve/carving/disjoint_sets.h"

namespace carve {
namespace {

/// Around a pixel, what a circle that is wider than a stroke meets: a stroke leaves it once for each of its arms.
class Circle {
 public:
  explicit Circle(double width) : radius_(std::max(4, static_cast<int>(std::lround(2 * width)))) {
    const int n = static_cast<int>(std::ceil(2 * std::numbers::pi * radius_));
    for (int k = 0; k < n; ++k) {
      const double angle = 2 * std::numbers::pi * k / n;
      offsets_.push_back({static_cast<int>(std::lround(radius_ * std::cos(angle))),
                          static_cast<int>(std::lround(radius_ * std::sin(angle)))});
    }
  }
  int radius() const { return radius_; }

  /// The mean of the directions in which the only arm leaves; zero if there is another number of arms, a wide one, or
  /// background.
  Vec2 arm(const Raster<Label>& label, int x, int y) const {
    const int n = static_cast<int>(offsets_.size());
    int arms = 0, pixels = 0;
    Vec2 sum = Vec2::Zero();
    bool before = at(label, x, y, n - 1) == Label::edge;
    for (int k = 0; k < n; ++k) {
      const Label here = at(label, x, y, k);
      if (here == Label::background) return Vec2::Zero();
      const bool on = here == Label::edge;
      if (on && !before && ++arms > 1) return Vec2::Zero();
      if (on) {
        ++pixels;
        sum += Vec2(offsets_[k][0], offsets_[k][1]);
      }
      before = on;
    }
    constexpr double kWide = 0.3;  // of the circle
    return arms == 1 && pixels < kWide * n ? sum.normalized().eval() : Vec2::Zero();
  }

 private:
  Label at(const Raster<Label>& label, int x, int y, int k) const {
    return label(x + offsets_[k][0], y + offsets_[k][1]);
  }
  int radius_;
  std::vector<std::array<int, 2>> offsets_;
};

/// The pixels from (x, y) on until one that is no surface any more; none if there are more than `longest`.
std::vector<int> way_from(const Raster<Label>& label, const StrokeEnd& end, const Vec2& direction, double longest) {
  constexpr double kStep = 0.5;
  std::vector<int> way;
  for (double t = kStep; t <= longest; t += kStep) {
    const int x = static_cast<int>(std::floor(end.x + 0.5 + t * direction.x()));
    const int y = static_cast<int>(std::floor(end.y + 0.5 + t * direction.y()));
    const int i = y * label.width + x;
    if (label.pixels[i] != Label::surface) {
      if (way.empty()) continue;  // still on the stroke's last pixels
      return way;
    }
    if (way.empty() || way.back() != i) way.push_back(i);
  }
  return {};
}

}  // namespace

std::vector<StrokeEnd> stroke_ends(const Raster<Label>& label, double width) {
  const Circle circle(width);
  const int w = label.width, margin = circle.radius();
  std::vector<int> near;  // pixels at an end, and their arms
  std::vector<Vec2> arm;
  DisjointSets sets(label.pixels.size());
  std::vector<std::uint8_t> set(label.pixels.size(), 0);
  for (int y = margin; y + margin < label.height; ++y)
    for (int x = margin; x + margin < w; ++x) {
      if (label(x, y) != Label::edge) continue;
      const Vec2 direction = circle.arm(label, x, y);
      if (direction.isZero()) continue;
      const int i = y * w + x;
      near.push_back(i);
      arm.push_back(direction);
      set[i] = 1;
      for (const int n : {i - 1, i - w - 1, i - w, i - w + 1})
        if (set[n]) sets.join(sets.find(n), sets.find(i));
    }
  std::vector<Vec2> onward(label.pixels.size(), Vec2::Zero());
  for (std::size_t k = 0; k < near.size(); ++k) onward[sets.find(near[k])] -= arm[k];
  std::vector<int> last(label.pixels.size(), -1);
  std::vector<int> names;
  for (const int i : near) {
    const int name = sets.find(i);
    if (onward[name].norm() < 1e-9) continue;
    if (last[name] < 0) names.push_back(name);
    const auto along = [&](int p) { return onward[name].dot(Vec2(p % w, p / w)); };
    if (last[name] < 0 || along(i) > along(last[name])) last[name] = i;
  }
  std::vector<StrokeEnd> ends;
  ends.reserve(names.size());
  for (const int name : names) ends.push_back({last[name] % w, last[name] / w, onward[name].normalized()});
  return ends;
}

Raster<int> cut_at_ends(const Raster<Label>& label, const Raster<int>& component, double width, double gap,
                        double longest) {
  constexpr int kTurn = 60, kStep = 5;  // degrees
  const int w = label.width;
  std::vector<std::uint8_t> cut(label.pixels.size(), 0);
  std::vector<int> pixels;
  const std::vector<StrokeEnd> ends = stroke_ends(label, width);
  for (const StrokeEnd& end : ends) {
    const auto leads_to_end = [&](int pixel) {
      return std::ranges::any_of(ends, [&](const StrokeEnd& other) {
        return &other != &end && std::hypot(other.x - pixel % w, other.y - pixel / w) <= 2 * width + 2;
      });
    };
    std::vector<int> shortest;
    for (int turn = 0; turn <= kTurn; turn += kStep)
      for (const int sign : {1, -1}) {
        const double angle = sign * turn * std::numbers::pi / 180;
        const Vec2 direction(end.onward.x() * std::cos(angle) - end.onward.y() * std::sin(angle),
                             end.onward.x() * std::sin(angle) + end.onward.y() * std::cos(angle));
        std::vector<int> way = way_from(label, end, direction, longest);
        if (!way.empty() && (shortest.empty() || way.size() < shortest.size())) shortest = std::move(way);
      }
    if (shortest.empty() || (shortest.size() <= gap && leads_to_end(shortest.back()))) continue;
    for (std::size_t k = 0; k < shortest.size(); ++k) {
      const auto mark = [&](int i) {
        if (cut[i] || component.pixels[i] < 0) return;
        cut[i] = 1;
        pixels.push_back(i);
      };
      mark(shortest[k]);
      // Across a corner, the cut takes one of the two pixels beside it, or the parts would touch there.
      if (k > 0 && std::abs(shortest[k] - shortest[k - 1]) != 1 && std::abs(shortest[k] - shortest[k - 1]) != w)
        mark(shortest[k - 1] / w * w + shortest[k] % w);
    }
  }
  if (pixels.empty()) return component;

  DisjointSets sets(label.pixels.size());
  Raster<int> part(w, label.height, -1);
  for (int i = 0; i < static_cast<int>(component.pixels.size()); ++i) {
    if (component.pixels[i] < 0 || cut[i]) continue;
    for (const int n : {i - 1, i - w})
      if (component.pixels[n] == component.pixels[i] && !cut[n]) sets.join(sets.find(n), sets.find(i));
  }
  for (int i = 0; i < static_cast<int>(component.pixels.size()); ++i)
    if (component.pixels[i] >= 0 && !cut[i]) part.pixels[i] = sets.find(i);
  while (!pixels.empty()) {
    std::vector<int> rest;
    for (const int i : pixels) {
      for (const int n : {i - 1, i - w, i + 1, i + w})
        if (part.pixels[i] < 0 && part.pixels[n] >= 0 && component.pixels[n] == component.pixels[i])
          part.pixels[i] = part.pixels[n];
      if (part.pixels[i] < 0) rest.push_back(i);
    }
    if (rest.size() == pixels.size()) {  // nothing else of the component is left
      for (const int i : rest) part.pixels[i] = i;
      break;
    }
    pixels = std::move(rest);
  }
  return part;
}

}  // namespace carve
