#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "carve/mesh/mesh.h"

namespace carve {

/// "" if the mesh is closed, oriented and 2-manifold: every edge in exactly two triangles that run through it in
/// opposite directions, the triangles of every vertex one fan, every vertex used. Else what is wrong.
inline std::string solid_fault(const Mesh& mesh) {
  struct HalfEdge {
    int from, to, triangle;
    auto operator<=>(const HalfEdge&) const = default;
  };
  std::vector<HalfEdge> edges;
  std::vector<int> degree(mesh.positions.size(), 0), first(mesh.positions.size(), -1);
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      if (a < 0 || a >= static_cast<int>(mesh.positions.size())) return "index out of range";
      if (a == b) return "degenerate triangle";
      edges.push_back({a, b, t});
      ++degree[a];
      first[a] = t;
    }
  std::sort(edges.begin(), edges.end());
  const auto find = [&](int from, int to) {
    return std::lower_bound(edges.begin(), edges.end(), HalfEdge{from, to, -1});
  };
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto [a, b, t] = edges[i];
    if (i > 0 && edges[i - 1].from == a && edges[i - 1].to == b) return "edge used twice in one direction";
    const auto twin = find(b, a);
    if (twin == edges.end() || twin->from != b || twin->to != a) return "edge of one triangle";
  }
  for (int v = 0; v < static_cast<int>(mesh.positions.size()); ++v) {
    if (first[v] < 0) return "unused vertex";
    int steps = 0, t = first[v];
    do {  // turn around v: across the edge that runs into it
      const Triangle& corners = mesh.triangles[t];
      const auto k = std::ranges::find(corners, v) - corners.begin();
      t = find(v, corners[(k + 2) % 3])->triangle;
      ++steps;
    } while (t != first[v] && steps <= degree[v]);
    if (steps != degree[v]) return "vertex with several fans";
  }
  return "";
}

inline double signed_volume(const Mesh& mesh) {
  double six = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
    six += p.x() * (q.y() * r.z() - q.z() * r.y()) + p.y() * (q.z() * r.x() - q.x() * r.z()) +
           p.z() * (q.x() * r.y() - q.y() * r.x());
  }
  return six / 6;
}

}  // namespace carve
