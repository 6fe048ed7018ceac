#include "carve/hull/polyhedral_hull.h"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "carve/core/error.h"
#include "carve/hull/exact_hull.h"

namespace carve {
namespace {

using namespace hull;

void check_silhouettes(const Silhouettes& silhouettes) {
  std::array<int, 3> given{};
  for (const Silhouette& silhouette : silhouettes.along) {
    if (silhouette.axis < 0 || silhouette.axis > 2)
      throw std::invalid_argument("a silhouette's axis must be 0, 1 or 2, got " + std::to_string(silhouette.axis));
    ++given[silhouette.axis];
    for (const LatticeLoop& loop : silhouette.loops) {
      if (loop.size() < 3)
        throw std::invalid_argument("a contour must have at least 3 vertices, got " + std::to_string(loop.size()));
      for (const LatticePoint& p : loop)
        if (std::min(p[0], p[1]) < 0 || std::max(p[0], p[1]) > kLattice)
          throw std::invalid_argument("a contour must lie in [0, " + std::to_string(kLattice) + "]^2, got (" +
                                      std::to_string(p[0]) + ", " + std::to_string(p[1]) + ")");
    }
  }
  if (silhouettes.along.size() < 2 || *std::max_element(given.begin(), given.end()) > 1)
    throw std::invalid_argument("a hull needs two or three silhouettes of different axes, got " +
                                std::to_string(silhouettes.along.size()));
}

// Vertices that turn, of loops that have any.
Silhouettes without_straight_vertices(Silhouettes silhouettes) {
  for (Silhouette& silhouette : silhouettes.along) {
    for (LatticeLoop& loop : silhouette.loops) {
      LatticeLoop kept;
      const auto straight = [](const LatticePoint& a, const LatticePoint& b, const LatticePoint& c) {
        const std::int64_t x = b[0] - a[0], y = b[1] - a[1], z = c[0] - b[0], w = c[1] - b[1];
        return x * w == y * z;
      };
      for (const LatticePoint& p : loop) {
        while (kept.size() > 1 && straight(kept[kept.size() - 2], kept.back(), p)) kept.pop_back();
        if (kept.empty() || kept.back() != p) kept.push_back(p);
      }
      while (kept.size() > 2 && straight(kept[kept.size() - 2], kept.back(), kept[0])) kept.pop_back();
      while (kept.size() > 2 && straight(kept.back(), kept[0], kept[1])) kept.erase(kept.begin());
      loop = kept.size() > 2 ? kept : LatticeLoop{};
    }
    std::erase_if(silhouette.loops, [](const LatticeLoop& loop) { return loop.empty(); });
  }
  return silhouettes;
}

// An axis along which nothing is drawn hides nothing.
Silhouettes with_all_axes(Silhouettes silhouettes) {
  constexpr std::int32_t low = -1, high = kLattice + 1;
  for (int axis = 0; axis < 3; ++axis) {
    const auto is_given = [&](const Silhouette& s) { return s.axis == axis; };
    if (std::any_of(silhouettes.along.begin(), silhouettes.along.end(), is_given)) continue;
    Silhouette all{axis, View::front, {{{low, low}, {high, low}, {high, high}, {low, high}}}};
    silhouettes.along.push_back(all);
  }
  return silhouettes;
}

/// Corners of one vertex: those that turning around the point from facet to facet leads to.
class Vertices {
 public:
  explicit Vertices(ExactHull& hull) : hull_(&hull) {
    number();
    if (part_touching_lines()) number();
  }
  int count() const { return static_cast<int>(points_.size()); }
  int of(int corner) const { return vertex_[corner]; }
  int point(int vertex) const { return points_[vertex]; }

 private:
  void number() {
    points_.clear();
    vertex_.assign(hull_->sides.size(), -1);
    for (int i = 0; i < static_cast<int>(hull_->sides.size()); ++i) {
      if (vertex_[i] >= 0) continue;
      for (int corner = i; vertex_[corner] < 0; corner = hull_->sides[hull_->sides[corner].partner].next)
        vertex_[corner] = count();
      points_.push_back(hull_->sides[i].from);
    }
  }

  // Two parts that touch along a line and are joined at both of its ends would share an edge: each gets a vertex of its
  // own in the middle of it.
  bool part_touching_lines() {
    std::map<std::pair<int, int>, std::vector<int>> lines;
    for (int i = 0; i < static_cast<int>(hull_->sides.size()); ++i) {
      const FacetSide& side = hull_->sides[i];
      if (side.touching && i < side.partner) lines[std::minmax(vertex_[i], vertex_[side.partner])].push_back(i);
    }
    bool parted = false;
    for (const auto& [ends, sides] : lines) {
      if (sides.size() < 2) continue;
      const int middle = add_middle(sides[0]);
      for (const int side : sides) insert_point(side, middle);
      parted = true;
    }
    return parted;
  }

  int add_middle(int side) {
    const ExactPoint& p = hull_->points[hull_->sides[side].from];
    const ExactPoint& q = hull_->points[hull_->sides[side].to];
    std::array<Int128, 3> sum;
    for (int axis = 0; axis < 3; ++axis)
      sum[axis] = static_cast<Int128>(p.whole[axis]) * p.den + p.rest[axis] +
                  static_cast<Int128>(q.whole[axis]) * q.den + q.rest[axis];
    hull_->points.push_back(exact_point(sum, p.den + q.den));
    return static_cast<int>(hull_->points.size()) - 1;
  }

  void insert_point(int index, int middle) {
    auto& sides = hull_->sides;
    const int other = sides[index].partner,
              second[2] = {static_cast<int>(sides.size()), static_cast<int>(sides.size()) + 1};
    for (int k = 0; k < 2; ++k) {
      const int first = k == 0 ? index : other;
      FacetSide rest = sides[first];
      rest.from = middle;
      rest.before = first;
      sides[rest.next].before = second[k];
      sides[first].to = middle;
      sides[first].next = second[k];
      sides.push_back(rest);
    }
    sides[index].partner = second[1];
    sides[second[1]].partner = index;
    sides[other].partner = second[0];
    sides[second[0]].partner = other;
  }

  ExactHull* hull_;
  std::vector<int> vertex_;  // of a corner
  std::vector<int> points_;  // of a vertex
};

// Copies of a point are drawn apart, each along its own edges (into the solid in the middle of a
// line), by this much of 1: hundreds of units in the last place,
// so that parts which only touch do not meet after rounding, and far below everything that is measured.
constexpr double kParting = 0x1p-44;

std::vector<Vec3> positions(const ExactHull& hull, const Vertices& vertices, const Silhouettes& silhouettes,
                            int& split_points) {
  std::vector<int> copies(hull.points.size());
  for (int v = 0; v < vertices.count(); ++v) split_points += copies[vertices.point(v)]++ > 0;
  const auto at = [&](int point) {
    Vec3 position;
    for (int axis = 0; axis < 3; ++axis)
      position[axis] = silhouettes.origin[axis] + silhouettes.unit[axis] * hull.points[point].coordinate(axis);
    return position;
  };
  std::vector<Vec3> all(vertices.count());
  for (int v = 0; v < vertices.count(); ++v) all[v] = at(vertices.point(v));
  if (split_points == 0) return all;
  std::vector<Vec3> along(all.size(), Vec3::Zero()), inwards(all.size(), Vec3::Zero());
  for (int i = 0; i < static_cast<int>(hull.sides.size()); ++i) {
    const auto& n = hull.planes[hull.sides[i].plane].normal;
    along[vertices.of(i)] += (at(hull.sides[i].to) - at(hull.sides[i].from)).normalized();
    inwards[vertices.of(i)] -= Vec3(n[0], n[1], n[2]).normalized();
  }
  for (int v = 0; v < vertices.count(); ++v)
    if (copies[vertices.point(v)] > 1)  // in the middle of a line, its two edges lead nowhere
      all[v] += kParting * (along[v].norm() > 1e-6 ? along[v] : inwards[v]);
  return all;
}

struct Rounded {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  std::vector<std::array<int, 3>> corners;  // of the triangles
  std::vector<int> sources;                 // of the triangles
  int facets = 0, split_points = 0;
};

/// Triangles and vertices of linked facets; adds to the hull what parting needs.
Rounded rounded(ExactHull& hull, const Silhouettes& silhouettes) {
  Vertices vertices(hull);
  Triangulation triangulation = triangulate_facets(hull.points, hull.planes, hull.sides);
  while (!triangulation.pinches.empty()) {
    split_pinches(hull.points, hull.planes, triangulation.pinches, hull.sides);
    vertices = Vertices(hull);
    triangulation = triangulate_facets(hull.points, hull.planes, hull.sides);
  }
  Rounded result;
  result.positions = positions(hull, vertices, silhouettes, result.split_points);
  for (const auto& corners : triangulation.triangles) {
    result.triangles.push_back({vertices.of(corners[0]), vertices.of(corners[1]), vertices.of(corners[2])});
    int source = hull.sides[corners[0]].source;
    for (const int corner : corners) source = std::min(source, hull.sides[corner].source);
    result.sources.push_back(source);
  }
  result.corners = std::move(triangulation.triangles);
  std::vector<char> seen(hull.sides.size());
  for (int i = 0; i < static_cast<int>(hull.sides.size()); ++i) {
    result.facets += !seen[i];
    for (int k = i; !seen[k]; k = hull.sides[k].next) seen[k] = true;
  }
  return result;
}

ExactHull made_by(const Silhouettes& clean, HullMethod method) {
  switch (method) {
    case HullMethod::nef:
      return nef(clean);
    case HullMethod::corefinement:
      return corefinement(clean);
    case HullMethod::strips:
      return strips(with_all_axes(clean));
    default:
      throw std::invalid_argument("a hull's method must be nef, corefinement or strips, got none");
  }
}

}  // namespace

namespace hull {

Prism prism(const Silhouette& silhouette) {
  Silhouettes alone;
  alone.along = {silhouette};
  alone.unit = Vec3::Ones();
  ExactHull swept = strips(with_all_axes(alone));
  swept.sides = link_facets(swept.points, swept.planes, std::move(swept.sides));
  const int edges = static_cast<int>(contour_edges(alone).size());
  const Rounded mesh = rounded(swept, alone);
  Prism result;
  for (const Vec3& p : mesh.positions) {
    const Vec3 integer = p.array().round();
    result.points.push_back(
        {static_cast<int>(integer.x()), static_cast<int>(integer.y()), static_cast<int>(integer.z())});
  }
  result.triangles = mesh.triangles;
  for (const int source : mesh.sources) result.edge.push_back(source < edges ? source : -1);
  return result;
}

}  // namespace hull

PolyhedralHull polyhedral_hull(const Silhouettes& silhouettes, HullMethod method, bool with_volume) {
  check_silhouettes(silhouettes);
  const Silhouettes clean = without_straight_vertices(silhouettes);
  ExactHull hull = made_by(clean, method);
  hull.sides = link_facets(hull.points, hull.planes, std::move(hull.sides));
  if (hull.sides.empty()) throw NoResult("the silhouettes' prisms have nothing in common");

  Rounded mesh = rounded(hull, clean);
  PolyhedralHull result;
  const std::vector<ContourEdge> edges = contour_edges(clean);
  for (const int source : mesh.sources) {
    const ContourEdge& edge = edges[source];
    result.sources.push_back({clean.along[edge.silhouette].view, edge.loop, edge.edge});
  }
  if (with_volume)
    result.volume = hull.volume.empty() ? exact_volume(hull.points, hull.sides, mesh.corners) : hull.volume;
  result.mesh = {std::move(mesh.positions), std::move(mesh.triangles)};
  result.facets = mesh.facets;
  result.split_points = mesh.split_points;
  return result;
}

}  // namespace carve
