#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>

#include "carve/core/vector.h"
#include "carve/hull/facets.h"

namespace carve::hull {
namespace {

using Sides = std::vector<FacetSide>;

// Groups of side indices with one key in 0..keys-1: counting sort.
struct Groups {
  std::vector<int> start, items;

  template <class Key>
  Groups(int count, int keys, Key&& key) : start(keys + 1), items() {
    for (int i = 0; i < count; ++i)
      if (key(i) >= 0) ++start[key(i) + 1];
    std::partial_sum(start.begin(), start.end(), start.begin());
    items.resize(start.back());
    std::vector<int> at(start.begin(), start.end() - 1);
    for (int i = 0; i < count; ++i)
      if (key(i) >= 0) items[at[key(i)]++] = i;
  }
  std::span<int> operator[](int k) { return {items.data() + start[k], items.data() + start[k + 1]}; }
};

class Linker {
 public:
  Linker(const std::vector<ExactPoint>& points, std::span<const FacetPlane> planes, Sides sides)
      : points_(points), planes_(planes), sides_(std::move(sides)) {}

  Sides run() {
    std::vector<int> loose = match();
    if (has_seams()) {  // what touches there may end elsewhere
      loose.resize(sides_.size());
      std::iota(loose.begin(), loose.end(), 0);
    }
    if (!loose.empty()) {
      split_where_others_end(loose);
      for (FacetSide& side : sides_) side.partner = -1, side.touching = false;
      if (!match().empty()) throw std::logic_error("the facets of a hull do not close");
    }
    for (FacetSide& side : sides_)
      if (FacetSide& other = sides_[side.partner]; side.plane == other.plane) side.plane = other.plane = -1;
    link_corners();
    drop_straight_points();
    return compacted();
  }

  Sides split(std::span<const Pinch> pinches) {
    std::vector<char> done(sides_.size());  // a side that is pinched twice is split again in the next round
    for (const Pinch& pinch : pinches)
      if (!done[pinch.side]) {
        done[pinch.side] = done[sides_[pinch.side].partner] = true;
        split(pinch);
      }
    link_corners();
    return std::move(sides_);
  }

 private:
  bool dropped(int side) const { return sides_[side].plane < 0; }
  void drop(int side) { sides_[side].plane = -1; }
  Vec3 position(int point) const {
    return {points_[point].coordinate(0), points_[point].coordinate(1), points_[point].coordinate(2)};
  }
  Vec3 normal(int side) const {
    const auto& n = planes_[sides_[side].plane].normal;
    return Vec3(n[0], n[1], n[2]).normalized();
  }

  std::vector<int> match();
  bool has_seams() const {
    return std::any_of(sides_.begin(), sides_.end(), [&](const FacetSide& side) {
      return side.partner >= 0 && side.plane == sides_[side.partner].plane &&
             side.source == sides_[side.partner].source;
    });
  }
  bool match_line(const std::vector<int>& forward, const std::vector<int>& backward);
  void pair_around(const std::vector<int>& forward, const std::vector<int>& backward);
  void split_where_others_end(const std::vector<int>& loose);
  bool in_one_line(int side, int other) const;
  void split_line(const std::vector<int>& line);
  void link_corners();
  void pair_in_plane(const std::vector<int>& in, const std::vector<int>& out);
  void split(const Pinch& pinch);
  void drop_straight_points();
  Sides compacted() const;

  const std::vector<ExactPoint>& points_;
  std::span<const FacetPlane> planes_;
  Sides sides_;
};

// Finds partners; returns the sides that have none because others end in the middle of them, or they of others.
std::vector<int> Linker::match() {
  Groups by_lower(static_cast<int>(sides_.size()), static_cast<int>(points_.size()),
                  [&](int i) { return dropped(i) ? -1 : std::min(sides_[i].from, sides_[i].to); });
  std::vector<int> loose, forward, backward;
  for (int lower = 0; lower < static_cast<int>(points_.size()); ++lower) {
    const std::span<int> group = by_lower[lower];
    const auto upper = [&](int i) { return std::max(sides_[i].from, sides_[i].to); };
    std::sort(group.begin(), group.end(),
              [&](int i, int j) { return std::pair(upper(i), i) < std::pair(upper(j), j); });
    for (auto i = group.begin(); i != group.end();) {
      forward.clear(), backward.clear();
      const int line = upper(*i);
      for (; i != group.end() && upper(*i) == line; ++i) (sides_[*i].from == lower ? forward : backward).push_back(*i);
      if (!match_line(forward, backward)) {
        loose.insert(loose.end(), forward.begin(), forward.end());
        loose.insert(loose.end(), backward.begin(), backward.end());
      }
    }
  }
  return loose;
}

// All sides between two points, those that run from the lower index to the higher one and those that run back.
bool Linker::match_line(const std::vector<int>& forward, const std::vector<int>& backward) {
  if (forward.size() != backward.size()) return false;
  if (forward.size() > 1) {
    pair_around(forward, backward);
  } else {
    sides_[forward[0]].partner = backward[0];
    sides_[backward[0]].partner = forward[0];
  }
  return true;
}

// Around a line in which several parts of the solid touch: facets that bound the same part become partners.
void Linker::pair_around(const std::vector<int>& forward, const std::vector<int>& backward) {
  const Vec3 along = (position(sides_[forward[0]].to) - position(sides_[forward[0]].from)).normalized();
  const Vec3 right = along.unitOrthogonal(), up = along.cross(right);
  struct Spoke {
    double angle;
    int side;
    bool forward;
  };
  std::vector<Spoke> spokes;
  const auto add = [&](int side, bool is_forward) {
    const Vec3 into = normal(side).cross(is_forward ? along : -along);  // from the line into the facet
    spokes.push_back({std::atan2(into.dot(up) + 0.0, into.dot(right)), side, is_forward});
    sides_[side].touching = true;
  };
  for (int side : forward) add(side, true);
  for (int side : backward) add(side, false);
  std::sort(spokes.begin(), spokes.end(),
            [](const Spoke& p, const Spoke& q) { return std::pair(p.angle, p.side) < std::pair(q.angle, q.side); });
  // Turning counter-clockwise about the line, the solid follows a backward side and ends at a forward one.
  const std::size_t count = spokes.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Spoke &first = spokes[i], &second = spokes[(i + 1) % count];
    if (first.forward) continue;
    if (!second.forward) throw std::logic_error("the facets around a line of a hull do not alternate");
    sides_[first.side].partner = second.side;
    sides_[second.side].partner = first.side;
  }
}

// Sides in one line, joined by common ends, cover each other up: each is split at all ends in its line.
void Linker::split_where_others_end(const std::vector<int>& loose) {
  std::vector<int> parent(loose.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  std::vector<std::pair<int, int>> ends;  // point, index in loose
  for (int i = 0; i < static_cast<int>(loose.size()); ++i) {
    ends.emplace_back(sides_[loose[i]].from, i);
    ends.emplace_back(sides_[loose[i]].to, i);
  }
  std::sort(ends.begin(), ends.end());
  for (std::size_t i = 0; i < ends.size(); ++i)
    for (std::size_t j = i + 1; j < ends.size() && ends[j].first == ends[i].first; ++j)
      if (in_one_line(loose[ends[i].second], loose[ends[j].second]))
        parent[root(ends[j].second)] = root(ends[i].second);

  std::map<int, std::vector<int>> lines;
  for (int i = 0; i < static_cast<int>(loose.size()); ++i) lines[root(i)].push_back(loose[i]);
  for (const auto& [ignored, line] : lines) split_line(line);
}

bool Linker::in_one_line(int side, int other) const {
  const FacetSide &s = sides_[side], &o = sides_[other];
  const ExactPoint &p = points_[s.from], &q = points_[s.to];
  const ExactPoint& r = points_[o.from == s.from || o.from == s.to ? o.to : o.from];
  return orientation(p, q, r, 0, 1) == 0 && orientation(p, q, r, 1, 2) == 0 && orientation(p, q, r, 2, 0) == 0;
}

void Linker::split_line(const std::vector<int>& line) {
  const ExactPoint &p = points_[sides_[line[0]].from], &q = points_[sides_[line[0]].to];
  int axis = 0;
  while (compare(p, q, axis) == 0) ++axis;
  std::vector<int> stops;
  for (const int side : line) {
    stops.push_back(sides_[side].from);
    stops.push_back(sides_[side].to);
  }
  const auto before = [&](int a, int b) { return compare(points_[a], points_[b], axis) < 0; };
  std::sort(stops.begin(), stops.end(), before);
  stops.erase(std::unique(stops.begin(), stops.end()), stops.end());
  for (const int side : line) {
    const FacetSide whole = sides_[side];
    const bool upwards = before(whole.from, whole.to);
    auto at = std::lower_bound(stops.begin(), stops.end(), upwards ? whole.from : whole.to, before);
    const int last = upwards ? whole.to : whole.from;
    for (bool first = true; *at != last; ++at, first = false) {
      FacetSide part = whole;
      part.from = upwards ? *at : at[1];
      part.to = upwards ? at[1] : *at;
      if (first)
        sides_[side] = part;
      else
        sides_.push_back(part);
    }
  }
}

void Linker::link_corners() {
  const int count = static_cast<int>(sides_.size()), points = static_cast<int>(points_.size());
  Groups leaving(count, points, [&](int i) { return dropped(i) ? -1 : sides_[i].from; });
  Groups arriving(count, points, [&](int i) { return dropped(i) ? -1 : sides_[i].to; });
  std::vector<int> in, out;
  const auto by_plane = [&](int i, int j) { return std::pair(sides_[i].plane, i) < std::pair(sides_[j].plane, j); };
  for (int point = 0; point < points; ++point) {
    const std::span<int> from = leaving[point], to = arriving[point];
    std::sort(from.begin(), from.end(), by_plane);
    std::sort(to.begin(), to.end(), by_plane);
    if (from.size() != to.size()) throw std::logic_error("a facet of a hull has an open border");
    for (std::size_t i = 0; i < from.size();) {
      const int plane = sides_[from[i]].plane;
      in.clear(), out.clear();
      for (; i < from.size() && sides_[from[i]].plane == plane; ++i) {
        out.push_back(from[i]);
        in.push_back(to[i]);
      }
      for (const int side : in)
        if (sides_[side].plane != plane) throw std::logic_error("a facet of a hull has an open border");
      if (in.size() == 1)
        sides_[in[0]].next = out[0];
      else
        pair_in_plane(in, out);
    }
  }
  for (int i = 0; i < count; ++i)
    if (!dropped(i)) sides_[sides_[i].next].before = i;
}

// Several corners of facets of one plane in one point: each is the angle from a side that leaves to the next one,
// counter-clockwise, that arrives.
void Linker::pair_in_plane(const std::vector<int>& in, const std::vector<int>& out) {
  const Vec3 up = normal(in[0]), x = up.unitOrthogonal(), y = up.cross(x);
  struct Spoke {
    double angle;
    int side;
    bool leaves;
  };
  std::vector<Spoke> spokes;
  const auto add = [&](int side, bool leaves) {
    const Vec3 way = (position(sides_[side].to) - position(sides_[side].from)) * (leaves ? 1 : -1);
    spokes.push_back({std::atan2(way.dot(y) + 0.0, way.dot(x)), side, leaves});
  };
  for (const int side : in) add(side, false);
  for (const int side : out) add(side, true);
  std::sort(spokes.begin(), spokes.end(),
            [](const Spoke& p, const Spoke& q) { return std::pair(p.angle, p.leaves) < std::pair(q.angle, q.leaves); });
  for (std::size_t i = 0; i < spokes.size(); ++i) {
    const Spoke &first = spokes[i], &second = spokes[(i + 1) % spokes.size()];
    if (!first.leaves) continue;
    if (second.leaves) throw std::logic_error("the corners of a hull's facets overlap");
    sides_[second.side].next = first.side;
  }
}

void Linker::split(const Pinch& pinch) {
  const int other = sides_[pinch.side].partner, count = static_cast<int>(sides_.size());
  for (const int side : {pinch.side, other}) {
    FacetSide rest = sides_[side];
    rest.from = pinch.point;
    sides_[side].to = pinch.point;
    sides_.push_back(rest);
  }
  const auto join = [&](int p, int q) {
    sides_[p].partner = q;
    sides_[q].partner = p;
  };
  join(pinch.side, count + 1);
  join(other, count);
}

// A corner's turn around its point leads to the neighbouring facet's corner; where that is back after two, both sides
// lie in the line of the two planes.
void Linker::drop_straight_points() {
  const auto turned = [&](int side) { return sides_[sides_[side].partner].next; };
  for (int i = 0; i < static_cast<int>(sides_.size()); ++i) {
    if (dropped(i)) continue;
    const int other = turned(i);
    if (other == i || turned(other) != i) continue;
    for (const int side : {i, other}) {
      FacetSide& kept = sides_[sides_[side].before];
      kept.to = sides_[side].to;
      kept.next = sides_[side].next;
      kept.touching |= sides_[side].touching;
      sides_[kept.next].before = sides_[side].before;
    }
    const int a = sides_[i].before, b = sides_[other].before;
    sides_[a].partner = b;
    sides_[b].partner = a;
    drop(i), drop(other);
  }
}

Sides Linker::compacted() const {
  std::vector<int> at(sides_.size(), -1);
  Sides kept;
  for (std::size_t i = 0; i < sides_.size(); ++i)
    if (!dropped(static_cast<int>(i))) {
      at[i] = static_cast<int>(kept.size());
      kept.push_back(sides_[i]);
    }
  for (FacetSide& side : kept) {
    side.next = at[side.next];
    side.before = at[side.before];
    side.partner = at[side.partner];
  }
  return kept;
}

}  // namespace

std::vector<FacetSide> link_facets(const std::vector<ExactPoint>& points, std::span<const FacetPlane> planes,
                                   std::vector<FacetSide> sides) {
  return Linker(points, planes, std::move(sides)).run();
}

void split_pinches(const std::vector<ExactPoint>& points, std::span<const FacetPlane> planes,
                   std::span<const Pinch> pinches, std::vector<FacetSide>& sides) {
  sides = Linker(points, planes, std::move(sides)).split(pinches);
}

}  // namespace carve::hull
