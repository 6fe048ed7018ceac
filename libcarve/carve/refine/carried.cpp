#include "carve/refine/carried.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>

#include "carve/core/parallel.h"

namespace carve::refining {
namespace {

constexpr int kGrain = 1 << 10;

class Carrier {
 public:
  Carrier(const Mesh& coarse, double reach) : coarse_(coarse), reach_(reach), normals_(vertex_normals(coarse)) {
    for (std::size_t v = 0; v < coarse.positions.size(); ++v)
      cells_[cell(coarse.positions[v])].push_back(static_cast<int>(v));
  }

  Mesh operator()(Mesh mesh, const Mesh& bent) const {
    const std::vector<Vec3> normals = vertex_normals(mesh);
    parallel_ranges(0, static_cast<int>(normals.size()), kGrain, [&](int first, int last) {
      for (int v = first; v < last; ++v) mesh.positions[v] += shift(mesh.positions[v], normals[v], bent);
    });
    return mesh;
  }

 private:
  using Cell = std::array<int, 3>;
  Cell cell(const Vec3& p) const {
    Cell c;
    for (int k = 0; k < 3; ++k) c[k] = static_cast<int>(std::floor(p[k] / reach_));
    return c;
  }

  static std::vector<Vec3> vertex_normals(const Mesh& mesh) {
    std::vector<Vec3> normals(mesh.positions.size(), Vec3::Zero());
    for (const auto& [a, b, c] : mesh.triangles) {
      const Vec3 n = (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]);
      for (const int v : {a, b, c}) normals[v] += n;
    }
    for (Vec3& n : normals) n = n.stableNormalized();
    return normals;
  }

  Vec3 shift(const Vec3& p, const Vec3& normal, const Mesh& bent) const {
    Vec3 sum = Vec3::Zero();
    double weight = 0;
    const auto [x, y, z] = cell(p);
    for (int i = x - 1; i <= x + 1; ++i)
      for (int j = y - 1; j <= y + 1; ++j)
        for (int k = z - 1; k <= z + 1; ++k) {
          const auto found = cells_.find({i, j, k});
          if (found == cells_.end()) continue;
          for (const int v : found->second) {
            const double near = 1 - (coarse_.positions[v] - p).norm() / reach_, facing = normals_[v].dot(normal);
            if (near <= 0 || facing <= 0) continue;
            sum += near * near * facing * (bent.positions[v] - coarse_.positions[v]);
            weight += near * near * facing;
          }
        }
    return weight > 0 ? Vec3(sum / weight) : Vec3::Zero();
  }

  const Mesh& coarse_;
  const double reach_;
  const std::vector<Vec3> normals_;
  std::map<Cell, std::vector<int>> cells_;
};

}  // namespace

Mesh carried(const Mesh& mesh, const Mesh& coarse, const Mesh& bent, double reach) {
  return Carrier(coarse, reach)(mesh, bent);
}

}  // namespace carve::refining
