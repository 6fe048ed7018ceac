#include <algorithm>
#include <bit>
#include <numeric>

#include "carve/hull/exact_hull.h"
#include "carve/hull/strip_clip.h"

namespace carve::hull {
namespace {

/// Edges of one silhouette by their range of one coordinate, in buckets.
class RangeIndex {
 public:
  RangeIndex(std::span<const ContourEdge> edges, int first, int coordinate) : first_(first) {
    const auto range = [&](int i) { return std::minmax(edges[i].from[coordinate], edges[i].to[coordinate]); };
    const int count = static_cast<int>(edges.size());
    std::int64_t entries;
    shift_ = std::max(0, 17 - static_cast<int>(std::bit_width(static_cast<unsigned>(count))));
    do {  // long edges lie in many buckets
      entries = 0;
      ++shift_;
      for (int i = 0; i < count; ++i) entries += bucket(range(i).second) - bucket(range(i).first) + 1;
    } while (entries > 8 * count && shift_ < 18);
    start_.assign(bucket(2 * kLattice) + 2, 0);
    for (int i = 0; i < count; ++i)
      for (int b = bucket(range(i).first); b <= bucket(range(i).second); ++b) ++start_[b + 1];
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    entries_.resize(start_.back());
    std::vector<int> at(start_.begin(), start_.end() - 1);
    for (int i = 0; i < count; ++i)
      for (int b = bucket(range(i).first), low = b; b <= bucket(range(i).second); ++b) entries_[at[b]++] = {i, low};
  }

  /// Calls visit(edge) for every edge whose bucket range meets [low, high], once each.
  template <class Visit>
  void find(std::int32_t low, std::int32_t high, Visit&& visit) const {
    const int lowest = bucket(low);
    for (int b = lowest; b <= bucket(high); ++b)
      for (int i = start_[b]; i < start_[b + 1]; ++i)
        if (b == std::max(lowest, entries_[i].lowest)) visit(first_ + entries_[i].edge);
  }

 private:
  int bucket(std::int32_t x) const { return (x + 2) >> shift_; }
  struct Entry {
    int edge, lowest;
  };
  int first_, shift_ = 0;
  std::vector<int> start_;
  std::vector<Entry> entries_;
};

class Strips {
 public:
  explicit Strips(const Silhouettes& silhouettes)
      : edges_(contour_edges(silhouettes)), swept_(swept_planes(silhouettes, edges_)) {
    for (const Silhouette& silhouette : silhouettes.along) axis_of_.push_back(silhouette.axis);
    for (int k = 0; k < static_cast<int>(axis_of_.size()); ++k) {
      const auto mine = [&](const ContourEdge& e) { return e.silhouette == k; };
      const auto first = std::find_if(edges_.begin(), edges_.end(), mine);
      const auto last = std::find_if_not(first, edges_.end(), mine);
      const int offset = static_cast<int>(first - edges_.begin());
      for (const int coordinate : {0, 1}) index_[axis_of_[k]].emplace_back(std::span(first, last), offset, coordinate);
    }
  }

  ExactHull run() {
    for (int edge = 0; edge < static_cast<int>(edges_.size()); ++edge) sweep(edge);
    return {points_.points(), std::move(swept_.planes), std::move(sides_)};
  }

 private:
  void sweep(int edge);
  void add_slab(int polygon, int axis, int slot, const ContourEdge& f);
  void add_section(int polygon, int axis, int slot, std::int32_t at, int inner, bool both_sides);
  void section(int axis, int slot, std::int32_t at, int inner, std::vector<Fraction>& values);
  static void intersect(const std::vector<Fraction>& p, const std::vector<Fraction>& q, std::vector<Fraction>& both);

  std::vector<ContourEdge> edges_;
  SweptPlanes swept_;
  std::vector<int> axis_of_;                      // of a silhouette
  std::array<std::vector<RangeIndex>, 3> index_;  // by axis, then coordinate; empty: no silhouette
  StripClipper clipper_;
  PointIndex points_;
  std::vector<FacetSide> sides_;
  std::vector<Fraction> inner_, outer_, section_;
};

// The strip of an edge in the plane of axes u and v, swept along axis w, is clipped by the silhouettes along u (in the
// plane of v and w) and along v (in the plane of w and u).
void Strips::sweep(int edge) {
  const ContourEdge& f = edges_[edge];
  const int w = axis_of_[f.silhouette], u = (w + 1) % 3, v = (w + 2) % 3;
  const std::int64_t du = f.to[0] - f.from[0], dv = f.to[1] - f.from[1];
  clipper_.clear();
  // A wall in the strip's plane belongs to the silhouette of the lower axis: others must be solid on both sides.
  if (dv == 0)
    add_section(0, u, 0, f.from[1], du > 0 ? 1 : -1, w > u);
  else
    add_slab(0, u, 0, f);
  if (du == 0)
    add_section(1, v, 1, f.from[0], dv > 0 ? -1 : 1, w > v);
  else
    add_slab(1, v, 1, f);

  const auto index = [&](const StripPoint& p) {
    std::array<Int128, 3> n;
    n[u] = static_cast<Int128>(f.from[0]) * p.d + static_cast<Int128>(du) * p.s;
    n[v] = static_cast<Int128>(f.from[1]) * p.d + static_cast<Int128>(dv) * p.s;
    n[w] = p.w;
    return points_(exact_point(n, p.d));
  };
  clipper_.run([&](const StripPoint& from, const StripPoint& to) {
    sides_.push_back({index(from), index(to), swept_.of_edge[edge], edge});
  });
}

// The sides of the silhouette along `axis` that the strip of f passes. Its coordinate `slot` is one of f's two, its
// other one runs along w.
void Strips::add_slab(int polygon, int axis, int slot, const ContourEdge& f) {
  if (index_[axis].empty()) return;
  const int mine = 1 - slot;  // f's coordinate
  const std::int64_t from = f.from[mine], step = f.to[mine] - from, sign = step > 0 ? 1 : -1;
  const std::int32_t low = std::min(f.from[mine], f.to[mine]), high = std::max(f.from[mine], f.to[mine]);
  const auto place = [&](std::int64_t x) { return Fraction{sign * (x - from), sign * step}; };
  index_[axis][slot].find(low, high, [&](int i) {
    const ContourEdge& g = edges_[i];
    const std::int32_t a = g.from[slot], b = g.to[slot];
    if (std::max(a, b) <= low || std::min(a, b) >= high) return;
    if (a == b) return clipper_.add_jump(place(a));
    // (w - wa) da = (x - a) dw with x = from + step s
    const std::int64_t wa = g.from[1 - slot], da = b - a, dw = g.to[1 - slot] - wa;
    const StripLine line{-step * dw, da, -wa * da - (from - a) * dw};
    const std::int32_t first = std::max(low, std::min(a, b)), last = std::min(high, std::max(a, b));
    clipper_.add_side(polygon, line, place(sign > 0 ? first : last), place(sign > 0 ? last : first));
  });
}

// Where the silhouette along `axis` is inside, along w, next to the plane in which its coordinate `slot` is `at`.
void Strips::add_section(int polygon, int axis, int slot, std::int32_t at, int inner, bool both_sides) {
  if (index_[axis].empty()) return;
  section(axis, slot, at, inner, inner_);
  if (both_sides) {
    section(axis, slot, at, -inner, outer_);
    intersect(inner_, outer_, section_);
  } else {
    section_ = inner_;
  }
  for (const Fraction& w : section_) clipper_.add_side(polygon, {0, w.d, -w.n}, {0, 1}, {1, 1});
}

void Strips::section(int axis, int slot, std::int32_t at, int inner, std::vector<Fraction>& values) {
  values.clear();
  index_[axis][slot].find(at, at, [&](int i) {
    const ContourEdge& g = edges_[i];
    const std::int64_t a = g.from[slot], b = g.to[slot];
    const auto [low, high] = std::minmax(a, b);
    if (inner > 0 ? at < low || at >= high : at <= low || at > high) return;
    const std::int64_t wa = g.from[1 - slot], dw = g.to[1 - slot] - wa, sign = b > a ? 1 : -1;
    values.push_back({sign * (wa * (b - a) + (at - a) * dw), sign * (b - a)});
  });
  std::sort(values.begin(), values.end(), [](const Fraction& p, const Fraction& q) { return compare(p, q) < 0; });
}

// Intersection of two sets of intervals, each the sorted ends of its intervals.
void Strips::intersect(const std::vector<Fraction>& p, const std::vector<Fraction>& q, std::vector<Fraction>& both) {
  both.clear();
  for (std::size_t i = 0, j = 0; i < p.size() && j < q.size();) {
    const Fraction& low = compare(p[i], q[j]) > 0 ? p[i] : q[j];
    const bool p_ends = compare(p[i + 1], q[j + 1]) < 0;
    const Fraction& high = p_ends ? p[i + 1] : q[j + 1];
    if (compare(low, high) < 0) both.insert(both.end(), {low, high});
    (p_ends ? i : j) += 2;
  }
}

}  // namespace

ExactHull strips(const Silhouettes& silhouettes) { return Strips(silhouettes).run(); }

}  // namespace carve::hull
