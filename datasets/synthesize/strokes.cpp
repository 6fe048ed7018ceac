#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "synthesize/view_samples.h"

namespace carve {
namespace {

using Hit = ViewSampler::Hit;

// Where between two neighbouring samples something ends.
struct End {
  double x, y;  // samples
  bool silhouette;
};

class Strokes {
 public:
  Strokes(const ViewSampler& sampler, const SampleBlock& block, const StrokeRule& rule)
      : sampler_(sampler),
        block_(block),
        rule_(rule),
        // Halved at least four times for a sub-sample place, and until a slope of 100 in 1 is no jump any more.
        halvings_(std::max(4, static_cast<int>(std::ceil(std::log2(100 * sampler.spacing() / rule.jump))))),
        cover_(block.width + 1, block.height) {}

  Mask ink() {
    for (int j = 0; j < block_.height; ++j)
      for (int i = 0; i < block_.width; ++i) {
        if (i + 1 < block_.width) between(i, j, i + 1, j);
        if (j + 1 < block_.height) between(i, j, i, j + 1);
      }
    Mask ink(block_.width, block_.height);
    for (int j = 0; j < block_.height; ++j)
      for (int i = 0, depth = 0; i < block_.width; ++i) ink(i, j) = (depth += cover_(i, j)) > 0 && block_.hit(i, j);
    return ink;
  }

 private:
  void between(int i, int j, int m, int n) {
    const std::size_t a = block_.at(i, j), b = block_.at(m, n);
    const Hit p{block_.triangle[a], block_.depth[a]}, q{block_.triangle[b], block_.depth[b]};
    if (p.triangle == q.triangle) return;
    const double x = i + 0.5, y = block_.first_row + j + 0.5;
    const auto end = p.triangle < 0 || q.triangle < 0           ? silhouette(p, x, y, m - i, n - j)
                     : std::abs(p.depth - q.depth) > rule_.jump ? jump(p, q, x, y, m - i, n - j)
                     : rule_.crease && turns(p.triangle, q.triangle)
                         ? std::optional(End{x + (m - i) / 2.0, y + (n - j) / 2.0, false})
                         : std::nullopt;
    if (end) stamp(*end);
  }

  bool turns(int p, int q) const {
    return sampler_.normal(p).dot(sampler_.normal(q)) < std::cos(*rule_.crease * std::numbers::pi / 180);
  }

  std::optional<End> silhouette(const Hit& p, double x, double y, int dx, int dy) const {
    double low = 0, high = 1;
    for (int k = 0; k < 4; ++k) {
      const double middle = (low + high) / 2;
      const bool as_first = (sampler_.hit(x + middle * dx, y + middle * dy).triangle < 0) == (p.triangle < 0);
      (as_first ? low : high) = middle;
    }
    const double t = (low + high) / 2;
    return End{x + t * dx, y + t * dy, true};
  }

  // Halves the gap between the two samples, keeping the half with the larger change of depth: what is left of the
  // change when the halves are small is a discontinuity.
  std::optional<End> jump(Hit p, Hit q, double x, double y, int dx, int dy) const {
    double low = 0, high = 1;
    for (int k = 0; k < halvings_; ++k) {
      const double middle = (low + high) / 2;
      const Hit h = sampler_.hit(x + middle * dx, y + middle * dy);
      if (h.triangle < 0) return End{x + middle * dx, y + middle * dy, false};  // a slit thinner than a sample
      if (std::abs(h.depth - p.depth) > std::abs(h.depth - q.depth))
        q = h, high = middle;
      else
        p = h, low = middle;
      if (std::abs(p.depth - q.depth) <= rule_.jump) return std::nullopt;
    }
    const double t = (low + high) / 2;
    return End{x + t * dx, y + t * dy, false};
  }

  // A disc of ink, as one span a row in a difference array.
  void stamp(const End& end) {
    const int s = rule_.samples;
    const double radius = (end.silhouette ? rule_.width : rule_.width / 2) * s;
    if (radius == 0) return;
    // The outline stays with the silhouette that it outlines.
    const bool wavers = rule_.waver && !end.silhouette;
    const auto [right, down] = wavers ? rule_.waver(end.x / s, end.y / s) : std::pair(0.0, 0.0);
    const double x = end.x + right * s, y = end.y + down * s - block_.first_row;
    const int top = std::max(0, static_cast<int>(std::ceil(y - radius - 0.5)));
    const int bottom = std::min(block_.height - 1, static_cast<int>(std::floor(y + radius - 0.5)));
    for (int j = top; j <= bottom; ++j) {
      const double dy = j + 0.5 - y, half = std::sqrt(std::max(0.0, radius * radius - dy * dy));
      const int from = std::max(0, static_cast<int>(std::ceil(x - half - 0.5)));
      const int to = std::min(block_.width - 1, static_cast<int>(std::floor(x + half - 0.5)));
      if (from > to) continue;
      ++cover_(from, j);
      --cover_(to + 1, j);
    }
  }

  const ViewSampler& sampler_;
  const SampleBlock& block_;
  const StrokeRule& rule_;
  int halvings_;
  Raster<int> cover_;
};

}  // namespace

Mask strokes(const ViewSampler& sampler, const SampleBlock& block, const StrokeRule& rule) {
  return Strokes(sampler, block, rule).ink();
}

}  // namespace carve
