#include "carve/hull/match_sides.h"

#include <map>

#include "carve/hull/around.h"

namespace carve::hull {
namespace {

class Matcher {
 public:
  Matcher(const std::vector<ExactPoint>& points, std::span<const FacetPlane> planes, std::vector<FacetSide> sides)
      : points_(points), planes_(planes), sides_(std::move(sides)) {}

  std::vector<FacetSide> run() {
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
    return std::move(sides_);
  }

 private:
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

  const std::vector<ExactPoint>& points_;
  std::span<const FacetPlane> planes_;
  std::vector<FacetSide> sides_;
};

// Finds partners; returns the sides that have none because others end in the middle of them, or they of others.
std::vector<int> Matcher::match() {
  Groups by_lower(static_cast<int>(sides_.size()), static_cast<int>(points_.size()),
                  [&](int i) { return std::min(sides_[i].from, sides_[i].to); });
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
bool Matcher::match_line(const std::vector<int>& forward, const std::vector<int>& backward) {
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
void Matcher::pair_around(const std::vector<int>& forward, const std::vector<int>& backward) {
  const Vec3 along =
      (position(points_[sides_[forward[0]].to]) - position(points_[sides_[forward[0]].from])).normalized();
  // Turning counter-clockwise about the line, the solid follows a backward side and ends at a forward one.
  Spokes spokes(along);
  const auto add = [&](int side, bool is_forward) {
    const Vec3 normal = unit_normal(planes_[sides_[side].plane]);
    spokes.add(normal.cross(is_forward ? along : -along), side, !is_forward);  // from the line into the facet
    sides_[side].touching = true;
  };
  for (const int side : forward) add(side, true);
  for (const int side : backward) add(side, false);
  spokes.each_sector("the facets around a line of a hull do not alternate", [&](int side, int other) {
    sides_[side].partner = other;
    sides_[other].partner = side;
  });
}

// Sides in one line, joined by common ends, cover each other up: each is split at all ends in its line.
void Matcher::split_where_others_end(const std::vector<int>& loose) {
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

bool Matcher::in_one_line(int side, int other) const {
  const FacetSide &s = sides_[side], &o = sides_[other];
  const ExactPoint &p = points_[s.from], &q = points_[s.to];
  const ExactPoint& r = points_[o.from == s.from || o.from == s.to ? o.to : o.from];
  return orientation(p, q, r, 0, 1) == 0 && orientation(p, q, r, 1, 2) == 0 && orientation(p, q, r, 2, 0) == 0;
}

void Matcher::split_line(const std::vector<int>& line) {
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

}  // namespace

std::vector<FacetSide> match_sides(const std::vector<ExactPoint>& points, std::span<const FacetPlane> planes,
                                   std::vector<FacetSide> sides) {
  return Matcher(points, planes, std::move(sides)).run();
}

}  // namespace carve::hull
