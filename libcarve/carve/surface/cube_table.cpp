#include "carve/surface/cube_table.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "carve/core/vector.h"

namespace carve {
namespace {

using Loop = std::vector<int>;  // edges of the cell, one vertex each
using Triangles = std::vector<std::array<int, 3>>;

int edge_between(int a, int b) {
  for (int edge = 0; edge < 12; ++edge)
    if (const auto [from, to] = cube_edge(edge); from == std::min(a, b) && to == std::max(a, b)) return edge;
  return -1;
}

/// A face's corners counter-clockwise seen from outside the cell.
std::array<int, 4> face_corners(int axis, int side) {
  const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, base = side << axis;
  if (side) return {base, base | u, base | u | v, base | v};
  return {base, base | v, base | u | v, base | u};
}

bool share_a_face(int edge, int other) {
  const auto [a, b] = cube_edge(edge);
  const auto [c, d] = cube_edge(other);
  return (a & b & c & d) != 0 || ((a | b | c | d) != 7);
}

/// Edge -> next edge along the loops, which run counter-clockwise seen from outside. On each face a segment cuts off
/// every run of inside corners, from the edge before the run's first to the one after its last.
std::array<int, 12> loop_links(int inside) {
  std::array<int, 12> next;
  next.fill(-1);
  const auto is_inside = [&](int corner) { return inside >> corner & 1; };
  for (int face = 0; face < 6; ++face) {
    const auto c = face_corners(face / 2, face % 2);
    for (int k = 0; k < 4; ++k) {
      if (is_inside(c[k]) || !is_inside(c[(k + 1) % 4])) continue;
      int end = (k + 1) % 4;
      while (is_inside(c[(end + 1) % 4])) end = (end + 1) % 4;
      next[edge_between(c[k], c[(k + 1) % 4])] = edge_between(c[end], c[(end + 1) % 4]);
    }
  }
  return next;
}

std::vector<Loop> loops(int inside) {
  std::array<int, 12> next = loop_links(inside);
  std::vector<Loop> result;
  for (int start = 0; start < 12; ++start) {
    if (next[start] < 0) continue;
    Loop loop;
    for (int edge = start; next[edge] >= 0;) {
      loop.push_back(edge);
      edge = std::exchange(next[edge], -1);
    }
    result.push_back(loop);
  }
  return result;
}

/// All triangulations of a loop.
std::vector<Triangles> triangulations(const Loop& loop) {
  if (loop.size() < 3) return {{}};
  std::vector<Triangles> result;
  for (std::size_t k = 1; k + 1 < loop.size(); ++k)
    for (const Triangles& before : triangulations(Loop(loop.begin(), loop.begin() + k + 1)))
      for (const Triangles& after : triangulations(Loop(loop.begin() + k, loop.end()))) {
        Triangles all = before;
        all.insert(all.end(), after.begin(), after.end());
        all.push_back({loop.front(), loop[k], loop.back()});
        result.push_back(all);
      }
  return result;
}

Vec3 middle(int edge) {
  Vec3 sum = Vec3::Zero();
  for (int corner : cube_edge(edge)) sum += Vec3(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
  return sum / 2;
}

double smallest_angle(const Triangles& triangles) {
  double smallest = 180;
  for (const auto& t : triangles)
    for (int k = 0; k < 3; ++k) {
      const Vec3 a = middle(t[(k + 1) % 3]) - middle(t[k]), b = middle(t[(k + 2) % 3]) - middle(t[k]);
      smallest = std::min(smallest, std::atan2(a.cross(b).norm(), a.dot(b)));
    }
  return smallest;
}

/// No inner edge joins two vertices on one face. A side of the loop always does.
bool stays_off_faces(const Triangles& triangles, const Loop& loop) {
  const auto side = [&](int a, int b) {
    const auto i = std::ranges::find(loop, a) - loop.begin(), j = std::ranges::find(loop, b) - loop.begin();
    const auto n = static_cast<std::ptrdiff_t>(loop.size());
    return (i + 1) % n == j || (j + 1) % n == i;
  };
  return std::ranges::all_of(triangles, [&](const auto& t) {
    for (int k = 0; k < 3; ++k)
      if (const int a = t[k], b = t[(k + 1) % 3]; !side(a, b) && share_a_face(a, b)) return false;
    return true;
  });
}

CubeCase cube_case(int inside) {
  CubeCase result;
  for (const Loop& loop : loops(inside)) {
    Triangles best;
    for (const Triangles& candidate : triangulations(loop))
      if (stays_off_faces(candidate, loop) && (best.empty() || smallest_angle(candidate) > smallest_angle(best) + 1e-9))
        best = candidate;
    for (const auto& [a, b, c] : best)
      result.edges[result.triangles++] = {static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b),
                                          static_cast<std::uint8_t>(c)};
  }
  return result;
}

}  // namespace

const std::array<CubeCase, 256>& cube_table() {
  static const auto table = [] {
    std::array<CubeCase, 256> cases;
    for (int inside = 0; inside < 256; ++inside) cases[inside] = cube_case(inside);
    return cases;
  }();
  return table;
}

}  // namespace carve
