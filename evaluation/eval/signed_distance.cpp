#include "eval/signed_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "carve/core/parallel.h"
#include "eval/point_triangle.h"

namespace carve {
namespace {

// For every vertex the first vertex at its position.
std::vector<int> weld(const std::vector<Vec3>& positions) {
  std::vector<int> order(positions.size()), first(positions.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int i) { return std::tuple(positions[i].x(), positions[i].y(), positions[i].z()); };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return std::pair(key(a), a) < std::pair(key(b), b); });
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i > 0 && key(order[i - 1]) == key(order[i]) ? first[order[i - 1]] : order[i];
  return first;
}

class PseudoNormals {
 public:
  explicit PseudoNormals(const Mesh& mesh)
      : mesh_(mesh), faces_(mesh.triangles.size()), edges_(mesh.triangles.size()), first_(weld(mesh.positions)) {
    corners_.assign(mesh.positions.size(), Vec3::Zero());
    for (std::size_t t = 0; t < faces_.size(); ++t) add_face(t);
    add_edges();
  }

  const Vec3& at(int triangle, Feature feature) const {
    switch (feature) {
      case Feature::face:
        return faces_[triangle];
      case Feature::corner_a:
      case Feature::corner_b:
      case Feature::corner_c:
        return corners_[first_[mesh_.triangles[triangle][static_cast<int>(feature) - 1]]];
      default:
        return edges_[triangle][static_cast<int>(feature) - 4];
    }
  }

 private:
  void add_face(std::size_t t) {
    const Triangle& triangle = mesh_.triangles[t];
    const auto position = [&](int k) -> const Vec3& { return mesh_.positions[triangle[k % 3]]; };
    const Vec3 normal = (position(1) - position(0)).cross(position(2) - position(0));
    faces_[t] = normal.norm() > 0 ? Vec3(normal.normalized()) : Vec3(Vec3::Zero());
    for (int k = 0; k < 3; ++k) {
      const Vec3 to_next = position(k + 1) - position(k), to_last = position(k + 2) - position(k);
      const double angle = std::atan2(to_next.cross(to_last).norm(), to_next.dot(to_last));
      corners_[first_[triangle[k]]] += angle * faces_[t];
    }
  }

  // Sum of the normals of all faces at each edge.
  void add_edges() {
    struct Use {
      int low, high, triangle, side;
    };
    std::vector<Use> uses;
    uses.reserve(3 * faces_.size());
    for (std::size_t t = 0; t < faces_.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        const int a = first_[mesh_.triangles[t][k]], b = first_[mesh_.triangles[t][(k + 1) % 3]];
        uses.push_back({std::min(a, b), std::max(a, b), static_cast<int>(t), k});
      }
    std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) {
      return std::tuple(a.low, a.high, a.triangle, a.side) < std::tuple(b.low, b.high, b.triangle, b.side);
    });
    for (std::size_t i = 0, end; i < uses.size(); i = end) {
      Vec3 sum = Vec3::Zero();
      for (end = i; end < uses.size() && uses[end].low == uses[i].low && uses[end].high == uses[i].high; ++end)
        sum += faces_[uses[end].triangle];
      for (std::size_t j = i; j < end; ++j) edges_[uses[j].triangle][uses[j].side] = sum;
    }
  }

  const Mesh& mesh_;
  std::vector<Vec3> faces_, corners_;
  std::vector<std::array<Vec3, 3>> edges_;  // ab, bc, ca
  std::vector<int> first_;
};

}  // namespace

std::vector<double> signed_distances(std::span<const Vec3> points, std::span<const Nearest> nearest, const Mesh& mesh,
                                     SignRule rule) {
  const PseudoNormals normals(mesh);
  std::vector<double> out(points.size());
  parallel_ranges(0, static_cast<int>(points.size()), 4096, [&](int first, int last) {
    for (int i = first; i < last; ++i) {
      const int t = nearest[i].triangle;
      const auto [a, b, c] = mesh.triangles[t];
      const Footpoint foot = closest_on_triangle(points[i], mesh.positions[a], mesh.positions[b], mesh.positions[c]);
      const Feature feature = rule == SignRule::pseudo_normal ? foot.feature : Feature::face;
      const double side = (points[i] - foot.point).dot(normals.at(t, feature));
      out[i] = side < 0 ? -nearest[i].distance : nearest[i].distance;
    }
  });
  return out;
}

}  // namespace carve
