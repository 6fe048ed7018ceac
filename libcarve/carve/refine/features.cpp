#include "carve/refine/features.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "carve/mesh/adjacency.h"

namespace carve::refining {
namespace {

Vec3 unit_normal(const Mesh& mesh, int triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  const Vec3& origin = mesh.positions[a];
  return (mesh.positions[b] - origin).cross(mesh.positions[c] - origin).stableNormalized();
}

bool has_side(const Triangle& t, int from, int to) {
  return (t[0] == from && t[1] == to) || (t[1] == from && t[2] == to) || (t[2] == from && t[0] == to);
}

}  // namespace

double mean_edge_length(const Mesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) sum += (mesh.positions[t[(k + 1) % 3]] - mesh.positions[t[k]]).norm();
  return mesh.triangles.empty() ? 0 : sum / (3.0 * static_cast<double>(mesh.triangles.size()));
}

std::vector<std::array<int, 3>> neighbours(const Mesh& mesh) {
  const VertexTriangles around = vertex_triangles(mesh);
  std::vector<std::array<int, 3>> result(mesh.triangles.size(), {-1, -1, -1});
  for (std::size_t i = 0; i < result.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const int from = mesh.triangles[i][k], to = mesh.triangles[i][(k + 1) % 3];
      for (const int other : around[from])
        if (has_side(mesh.triangles[other], to, from)) result[i][k] = other;
    }
  return result;
}

std::vector<std::array<std::uint8_t, 3>> feature_sides(const Mesh& mesh, double degrees) {
  const double lowest = std::cos(degrees * std::numbers::pi / 180);
  std::vector<Vec3> normals(mesh.triangles.size());
  for (std::size_t i = 0; i < normals.size(); ++i) normals[i] = unit_normal(mesh, static_cast<int>(i));
  const auto beyond = neighbours(mesh);
  std::vector<std::array<std::uint8_t, 3>> sides(normals.size());
  for (std::size_t i = 0; i < normals.size(); ++i)
    for (int k = 0; k < 3; ++k) sides[i][k] = normals[i].dot(normals[beyond[i][k]]) < lowest;
  return sides;
}

}  // namespace carve::refining
