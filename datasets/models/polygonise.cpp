#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <unordered_map>

#include "carve/core/parallel.h"
#include "models/primitives.h"

namespace carve {
namespace {

// Samples of the field on a lattice; the surface runs between lattice points of different sign.
class Tetrahedra {
 public:
  Tetrahedra(const std::function<double(const Vec3&)>& field, const Vec3& low, const Vec3& high, double spacing)
      : low_(low), spacing_(spacing), size_(((high - low) / spacing).array().ceil().cast<int>() + 1) {
    values_.resize(static_cast<std::size_t>(size_.x()) * size_.y() * size_.z());
    parallel_ranges(0, size_.z(), 1, [&](int first, int last) {
      for (int z = first; z < last; ++z)
        for (int y = 0; y < size_.y(); ++y)
          for (int x = 0; x < size_.x(); ++x) values_[index({x, y, z})] = field(at({x, y, z}));
    });
  }

  Mesh surface() {
    // Each cube is cut into the six tetrahedra around its diagonal: neighbouring cubes' faces are cut alike.
    constexpr std::array<std::array<int, 3>, 6> orders{
        {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
    for (int z = 0; z + 1 < size_.z(); ++z)
      for (int y = 0; y + 1 < size_.y(); ++y)
        for (int x = 0; x + 1 < size_.x(); ++x)
          for (const auto& order : orders) {
            std::array<Vec3i, 4> corner;
            corner[0] = {x, y, z};
            for (int i = 0; i < 3; ++i) corner[i + 1] = corner[i] + Vec3i::Unit(order[i]);
            tetrahedron(corner);
          }
    return std::move(mesh_);
  }

 private:
  std::int64_t index(const Vec3i& p) const {
    return (static_cast<std::int64_t>(p.z()) * size_.y() + p.y()) * size_.x() + p.x();
  }
  Vec3 at(const Vec3i& p) const { return low_ + spacing_ * p.cast<double>(); }
  bool inside(const Vec3i& p) const { return values_[index(p)] < 0; }

  // The crossing on the edge from an inside to an outside lattice point.
  int vertex(const Vec3i& in, const Vec3i& out) {
    const auto key = std::pair{index(in), index(out)};
    const auto [found, is_new] = vertices_.try_emplace(key.first * 27 + code(out - in), 0);
    if (!is_new) return found->second;
    const double a = values_[key.first], b = values_[key.second];
    // Kept off the lattice points, where triangles would lose their area.
    const double t = std::clamp(a / (a - b), 0.02, 0.98);
    mesh_.positions.push_back(at(in) + t * (at(out) - at(in)));
    return found->second = static_cast<int>(mesh_.positions.size()) - 1;
  }
  static int code(const Vec3i& step) { return (step.x() + 1) * 9 + (step.y() + 1) * 3 + step.z() + 1; }

  void triangle(int a, int b, int c, const Vec3& outward) {
    const Vec3 normal = (mesh_.positions[b] - mesh_.positions[a]).cross(mesh_.positions[c] - mesh_.positions[a]);
    if (normal.dot(outward) < 0) std::swap(b, c);
    mesh_.triangles.push_back({a, b, c});
  }

  void tetrahedron(const std::array<Vec3i, 4>& corner) {
    std::array<Vec3i, 4> in, out;
    int n = 0, m = 0;
    for (const Vec3i& p : corner) (inside(p) ? in[n++] : out[m++]) = p;
    if (n == 0 || m == 0) return;
    Vec3 outward = Vec3::Zero();
    for (int i = 0; i < m; ++i) outward += at(out[i]) / m;
    for (int i = 0; i < n; ++i) outward -= at(in[i]) / n;
    if (n == 1) triangle(vertex(in[0], out[0]), vertex(in[0], out[1]), vertex(in[0], out[2]), outward);
    if (m == 1) triangle(vertex(in[0], out[0]), vertex(in[1], out[0]), vertex(in[2], out[0]), outward);
    if (n == 2) {
      const int a = vertex(in[0], out[0]), b = vertex(in[0], out[1]), c = vertex(in[1], out[1]),
                d = vertex(in[1], out[0]);
      triangle(a, b, c, outward);
      triangle(a, c, d, outward);
    }
  }

  Vec3 low_;
  double spacing_;
  Vec3i size_;
  std::vector<double> values_;
  std::unordered_map<std::int64_t, int> vertices_;
  Mesh mesh_;
};

}  // namespace

Mesh polygonise(const std::function<double(const Vec3&)>& field, const Vec3& low, const Vec3& high, double spacing) {
  return Tetrahedra(field, low, high, spacing).surface();
}

}  // namespace carve
