#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "carve/hull/facets.h"

namespace carve::hull {
namespace {

using Triple = std::array<int, 3>;

/// Corners on the border of what is triangulated so far, from the lower side's left end up to the upper side's.
class Chain {
 public:
  void start(int corner) {
    items_.assign(1, corner);
    head_ = 0;
  }
  int size() const { return static_cast<int>(items_.size()) - head_; }
  int operator[](int i) const { return items_[head_ + i]; }
  int from_top(int i) const { return items_[items_.size() - 1 - i]; }
  void push_top(int corner) { items_.push_back(corner); }
  void pop_top() { items_.pop_back(); }
  void pop_bottom() { ++head_; }
  void push_bottom(int corner) {
    if (head_ == 0) {
      head_ = size() + 4;
      items_.insert(items_.begin(), head_, -1);
    }
    items_[--head_] = corner;
  }
  void append(const Chain& other, int skip) {
    items_.insert(items_.end(), other.items_.begin() + other.head_ + skip, other.items_.end());
  }
  void assign(const Chain& other, int first, int last) {
    items_.assign(other.items_.begin() + other.head_ + first, other.items_.begin() + other.head_ + last);
    head_ = 0;
  }

 private:
  std::vector<int> items_;
  int head_ = 0;
};

/// The inside between two sides that the sweep has entered and not left: `lower` runs to the right, `upper` back.
struct Gap {
  int lower = -1, upper = -1;
  Chain chain;
};

class Sweep {
 public:
  Sweep(const std::vector<ExactPoint>& points, std::span<const FacetSide> sides, std::vector<Triple>& triangles)
      : points_(points), sides_(sides), triangles_(triangles), gap_of_(sides.size(), -1) {}

  void plane(const std::array<std::int64_t, 3>& normal, std::span<int> sides) {
    int axis = 0;
    for (int k = 1; k < 3; ++k)
      if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
    x_ = (axis + 1) % 3, y_ = (axis + 2) % 3;
    if (normal[axis] < 0) std::swap(x_, y_);

    std::sort(sides.begin(), sides.end(), [&](int i, int j) {
      const int order = compare_points(sides_[i].from, sides_[j].from);
      return order != 0 ? order < 0 : i < j;
    });
    for (auto i = sides.begin(); i != sides.end();) {
      auto end = i;
      while (end != sides.end() && sides_[*end].from == sides_[*i].from) ++end;
      event(sides_[*i].from, {i, end});
      if (pinched_) break;
      i = end;
    }
    if (pinched_) {
      pinched_ = false;
      active_.clear(), gaps_.clear(), free_.clear();
    }
  }
  const std::vector<Pinch>& pinches() const { return pinches_; }

 private:
  int compare_points(int p, int q) const {
    if (p == q) return 0;
    const int order = compare(points_[p], points_[q], x_);
    return order != 0 ? order : compare(points_[p], points_[q], y_);
  }
  int orient(int p, int q, int r) const { return orientation(points_[p], points_[q], points_[r], x_, y_); }
  int point(int corner) const { return sides_[corner].from; }
  bool leaves(int side, int p) const { return sides_[side].from == p; }
  int far_end(int side, int p) const { return leaves(side, p) ? sides_[side].to : sides_[side].from; }

  int new_gap() {
    if (free_.empty()) {
      free_.push_back(static_cast<int>(gaps_.size()));
      gaps_.emplace_back();
    }
    const int gap = free_.back();
    free_.pop_back();
    active_.push_back(gap);
    return gap;
  }
  void free_gap(int gap) {
    active_.erase(std::find(active_.begin(), active_.end(), gap));
    free_.push_back(gap);
  }
  void set_lower(int gap, int side) { gap_of_[gaps_[gap].lower = side] = gap; }
  void set_upper(int gap, int side) { gap_of_[gaps_[gap].upper = side] = gap; }

  void event(int p, std::span<const int> corners);
  void advance_top(Chain& chain, int corner);
  void advance_bottom(Chain& chain, int corner);
  void close(int gap, int corner);
  void merge(int below, int above, int corner);
  void split(int gap, int corner, int upper, int lower);
  int gap_around(int p) const;
  void look_for_pinch(int side, int p) {
    if (orient(sides_[side].from, sides_[side].to, p) != 0) return;
    pinches_.push_back({side, p});
    pinched_ = true;
  }

  const std::vector<ExactPoint>& points_;
  std::span<const FacetSide> sides_;
  std::vector<Triple>& triangles_;
  std::vector<int> gap_of_;  // of a side that the sweep line cuts
  std::vector<Gap> gaps_;
  std::vector<int> active_, free_, ending_, starting_;
  std::vector<Pinch> pinches_;
  bool pinched_ = false;  // in this plane
  int x_ = 0, y_ = 1;
};

// All sides that end or start in a point, from the lowest up. A side is the upper one of its gap if it runs to the
// left.
void Sweep::event(int p, std::span<const int> corners) {
  ending_.clear(), starting_.clear();
  for (const int corner : corners)
    for (const int side : {corner, sides_[corner].before})
      (compare_points(far_end(side, p), p) < 0 ? ending_ : starting_).push_back(side);
  // Both sides of a seam run to one point: the upper one of the gap below it comes first.
  std::sort(ending_.begin(), ending_.end(), [&](int e, int f) {
    const int order = e == f ? 0 : orient(p, far_end(f, p), far_end(e, p));
    return order != 0 ? order > 0 : leaves(e, p) > leaves(f, p);
  });
  std::sort(starting_.begin(), starting_.end(), [&](int e, int f) {
    const int order = e == f ? 0 : orient(p, far_end(e, p), far_end(f, p));
    return order != 0 ? order > 0 : leaves(e, p) < leaves(f, p);
  });

  std::size_t e = 0, s = 0;
  int below = -1, above = -1;
  if (!ending_.empty() && leaves(ending_[0], p)) below = gap_of_[ending_[e++]];
  for (; e + 1 < ending_.size(); e += 2) close(gap_of_[ending_[e]], ending_[e + 1]);
  if (e < ending_.size()) above = gap_of_[ending_[e]];

  const bool upper_starts = !starting_.empty() && !leaves(starting_[0], p);
  if (upper_starts) ++s;
  for (; s + 1 < starting_.size(); s += 2) {
    const int gap = new_gap();
    set_lower(gap, starting_[s]);
    set_upper(gap, starting_[s + 1]);
    gaps_[gap].chain.start(starting_[s]);
  }
  const bool lower_starts = s < starting_.size();

  if (below >= 0) look_for_pinch(gaps_[below].lower, p);
  if (above >= 0) look_for_pinch(gaps_[above].upper, p);
  if (below >= 0 && above >= 0 && starting_.empty()) {
    merge(below, above, ending_.front());
  } else if (ending_.empty() && upper_starts && lower_starts) {
    split(gap_around(p), starting_.back(), starting_.front(), starting_.back());
  } else {
    if ((below >= 0) != upper_starts || (above >= 0) != lower_starts)
      throw std::logic_error("a facet of a hull has crossing sides");
    if (upper_starts) {
      advance_top(gaps_[below].chain, ending_.front());
      set_upper(below, starting_.front());
    }
    if (lower_starts) {
      advance_bottom(gaps_[above].chain, starting_.back());
      set_lower(above, starting_.back());
    }
  }
}

void Sweep::advance_top(Chain& chain, int corner) {
  for (; chain.size() >= 2; chain.pop_top()) {
    const int a = chain.from_top(1), b = chain.from_top(0);
    if (orient(point(a), point(corner), point(b)) <= 0) break;
    triangles_.push_back({a, corner, b});
  }
  chain.push_top(corner);
}

void Sweep::advance_bottom(Chain& chain, int corner) {
  for (; chain.size() >= 2; chain.pop_bottom()) {
    const int a = chain[0], b = chain[1];
    if (orient(point(a), point(corner), point(b)) <= 0) break;
    triangles_.push_back({a, corner, b});
  }
  chain.push_bottom(corner);
}

void Sweep::close(int gap, int corner) {
  advance_top(gaps_[gap].chain, corner);
  if (gaps_[gap].chain.size() != 2) throw std::logic_error("a facet of a hull has crossing sides");
  free_gap(gap);
}

void Sweep::merge(int below, int above, int corner) {
  advance_top(gaps_[below].chain, corner);
  advance_bottom(gaps_[above].chain, corner);
  gaps_[below].chain.append(gaps_[above].chain, 1);
  set_upper(below, gaps_[above].upper);
  free_gap(above);
}

// A point inside a gap sees the chain's rightmost corner, and what it sees beside that below and above.
void Sweep::split(int gap, int corner, int upper, int lower) {
  look_for_pinch(gaps_[gap].lower, point(corner));
  look_for_pinch(gaps_[gap].upper, point(corner));
  const int other = new_gap();
  const Chain whole = gaps_[gap].chain;
  int rightmost = 0;
  for (int i = 1; i < whole.size(); ++i)
    if (compare_points(point(whole[i]), point(whole[rightmost])) > 0) rightmost = i;
  gaps_[gap].chain.assign(whole, 0, rightmost + 1);
  gaps_[other].chain.assign(whole, rightmost, whole.size());
  advance_top(gaps_[gap].chain, corner);
  advance_bottom(gaps_[other].chain, corner);
  set_upper(other, gaps_[gap].upper);
  set_lower(other, lower);
  set_upper(gap, upper);
}

int Sweep::gap_around(int p) const {
  for (const int gap : active_) {
    const FacetSide &lower = sides_[gaps_[gap].lower], &upper = sides_[gaps_[gap].upper];
    if (orient(lower.from, lower.to, p) >= 0 && orient(upper.from, upper.to, p) >= 0) return gap;
  }
  throw std::logic_error("a hole of a hull's facet lies outside it");
}

}  // namespace

Triangulation triangulate_facets(const std::vector<ExactPoint>& points, std::span<const FacetPlane> planes,
                                 std::span<const FacetSide> sides) {
  std::vector<int> start(planes.size() + 1), order(sides.size());
  for (const FacetSide& side : sides) ++start[side.plane + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<int> at(start.begin(), start.end() - 1);
  for (int i = 0; i < static_cast<int>(sides.size()); ++i) order[at[sides[i].plane]++] = i;

  std::vector<Triple> triangles;
  triangles.reserve(2 * sides.size());
  Sweep sweep(points, sides, triangles);
  for (std::size_t plane = 0; plane < planes.size(); ++plane)
    sweep.plane(planes[plane].normal, {order.begin() + start[plane], order.begin() + start[plane + 1]});
  return {std::move(triangles), sweep.pinches()};
}

}  // namespace carve::hull
