#include "carve/hull/around.h"
#include "carve/hull/match_sides.h"

namespace carve::hull {
namespace {

using Sides = std::vector<FacetSide>;

class Linker {
 public:
  Linker(const std::vector<ExactPoint>& points, std::span<const FacetPlane> planes, Sides sides)
      : points_(points), planes_(planes), sides_(std::move(sides)) {}

  Sides run() {
    sides_ = match_sides(points_, planes_, std::move(sides_));
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
  void link_corners();
  void pair_in_plane(const std::vector<int>& in, const std::vector<int>& out);
  void split(const Pinch& pinch);
  void drop_straight_points();
  Sides compacted() const;

  const std::vector<ExactPoint>& points_;
  std::span<const FacetPlane> planes_;
  Sides sides_;
};

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
  Spokes spokes(unit_normal(planes_[sides_[in[0]].plane]));
  const auto add = [&](int side, bool leaves) {
    const Vec3 way = position(points_[sides_[side].to]) - position(points_[sides_[side].from]);
    spokes.add(leaves ? way : -way, side, leaves);
  };
  for (const int side : in) add(side, false);
  for (const int side : out) add(side, true);
  spokes.each_sector("the corners of a hull's facets overlap", [&](int side, int other) { sides_[other].next = side; });
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
