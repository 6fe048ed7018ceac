#include "carve/mesh/neighbours.h"

#include <Eigen/Geometry>

#include "carve/core/parallel.h"
#include "carve/mesh/adjacency.h"

namespace carve {

std::vector<std::array<int, 3>> triangle_neighbours(const Mesh& mesh) {
  const VertexTriangles around = vertex_triangles(mesh);
  std::vector<std::array<int, 3>> all(mesh.triangles.size());
  parallel_ranges(0, static_cast<int>(all.size()), 4096, [&](int first, int last) {
    for (int t = first; t < last; ++t)
      for (int k = 0; k < 3; ++k) {
        const int from = mesh.triangles[t][k], to = mesh.triangles[t][(k + 1) % 3];
        all[t][k] = -1;
        for (const int other : around[from]) {
          const Triangle& o = mesh.triangles[other];
          if (other == t ||
              !((o[0] == to && o[1] == from) || (o[1] == to && o[2] == from) || (o[2] == to && o[0] == from)))
            continue;
          all[t][k] = other;
          break;
        }
      }
  });
  return all;
}

std::vector<Vec3> triangle_normals(const Mesh& mesh) {
  std::vector<Vec3> normals(mesh.triangles.size());
  parallel_ranges(0, static_cast<int>(normals.size()), 4096, [&](int first, int last) {
    for (int t = first; t < last; ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      const Vec3& origin = mesh.positions[a];
      normals[t] = (mesh.positions[b] - origin).cross(mesh.positions[c] - origin).stableNormalized();
    }
  });
  return normals;
}

}  // namespace carve
