#include "carve/mesh/triangle_tests.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace carve {
namespace {

// Of a sum of three products of rounded differences, in units of its largest terms; ten times what is needed.
constexpr double kRounding = 64 * std::numeric_limits<double>::epsilon();

/// The reach of a triangle or a star around an origin: the largest difference of a coordinate.
double reach(const Vec3& d) { return d.cwiseAbs().maxCoeff(); }

/// Whether triangles `a` and `b`, given as differences from one point, lie on two sides of a plane across `axis`.
bool apart_along(const Vec3& axis, const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double far) {
  const double slack = kRounding * axis.cwiseAbs().sum() * far;
  const auto [a_low, a_high] = std::minmax({axis.dot(a[0]), axis.dot(a[1]), axis.dot(a[2])});
  const auto [b_low, b_high] = std::minmax({axis.dot(b[0]), axis.dot(b[1]), axis.dot(b[2])});
  return a_high + slack < b_low || b_high + slack < a_low;
}

/// Whether a plane along triangle `a` or across it through one of its sides separates it from `b`.
bool apart(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double far) {
  const Vec3 normal = (a[1] - a[0]).cross(a[2] - a[0]);
  if (apart_along(normal, a, b, far)) return true;
  for (int k = 0; k < 3; ++k)
    if (apart_along(normal.cross(a[(k + 1) % 3] - a[k]), a, b, far)) return true;
  return false;
}

/// Whether `b` lies on one side of the plane of `a`, but for the corner they share.
bool apart_at_corner(const Mesh& mesh, const Triangle& a, int at_a, const Triangle& b, int at_b) {
  const Vec3& origin = mesh.positions[a[at_a]];
  const auto from_corner = [&](const Triangle& t, int k) { return Vec3(mesh.positions[t[k % 3]] - origin); };
  const Vec3 p = from_corner(a, at_a + 1), q = from_corner(a, at_a + 2);
  const Vec3 r = from_corner(b, at_b + 1), s = from_corner(b, at_b + 2);
  const Vec3 normal = p.cross(q);
  const double clear = kRounding * reach(p) * reach(q) * std::max(reach(r), reach(s));
  const double side_r = normal.dot(r), side_s = normal.dot(s);
  return (side_r > clear && side_s > clear) || (side_r < -clear && side_s < -clear);
}

}  // namespace

bool is_plain(const Mesh& mesh, std::span<const int> star, int vertex) {
  constexpr std::size_t kMost = 24;
  if (star.size() < 3 || star.size() > kMost) return false;
  const Vec3& origin = mesh.positions[vertex];
  std::array<int, kMost> from, to;
  std::array<Vec3, kMost> ahead, normal;  // towards `from`
  Vec3 sum = Vec3::Zero();
  double far = 0;
  for (std::size_t i = 0; i < star.size(); ++i) {
    const Triangle& t = mesh.triangles[star[i]];
    const int k = t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2;
    from[i] = t[(k + 1) % 3], to[i] = t[(k + 2) % 3];
    ahead[i] = mesh.positions[from[i]] - origin;
    far = std::max(far, reach(ahead[i]));
  }
  std::array<int, kMost> next;
  for (std::size_t i = 0; i < star.size(); ++i) {
    int followers = 0;
    for (std::size_t j = 0; j < star.size(); ++j)
      if (from[j] == to[i]) next[i] = static_cast<int>(j), ++followers;
    if (followers != 1) return false;
    normal[i] = ahead[i].cross(ahead[next[i]]);
    sum += normal[i];
  }
  const double least = kRounding * sum.cwiseAbs().sum() * far;
  for (std::size_t i = 0; i < star.size(); ++i)
    if (!(sum.dot(normal[i]) > least * far)) return false;
  // Once around: one step over a ray that ends in the vertex. In lattices this one passes between the others.
  const Vec3 across = sum.cross(0.62 * ahead[0] + 0.38 * ahead[next[0]]);
  const double clear = kRounding * across.cwiseAbs().sum() * far;
  std::array<double, kMost> side;
  for (std::size_t i = 0; i < star.size(); ++i) {
    side[i] = across.dot(ahead[i]);
    if (!(std::abs(side[i]) > clear)) return false;
  }
  int turns = 0;
  for (std::size_t i = 0; i < star.size(); ++i) turns += side[i] < 0 && side[next[i]] > 0;
  return turns == 1;
}

Vec3i faces(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a, v = c - a, normal = u.cross(v);
  const double clear = kRounding * reach(u) * reach(v);
  Vec3i signs;
  for (int k = 0; k < 3; ++k) signs[k] = (normal[k] > clear) - (normal[k] < -clear);
  return signs;
}

int crossings(const Mesh& mesh, int triangle, const Vec3& point, int axis) {
  const int right = (axis + 1) % 3, up = (axis + 2) % 3;
  std::array<Vec2, 3> corner;
  double far = 0;
  for (int k = 0; k < 3; ++k) {
    const Vec3 d = mesh.positions[mesh.triangles[triangle][k]] - point;
    corner[k] = {d[right], d[up]};
    far = std::max({far, std::abs(d[right]), std::abs(d[up])});
  }
  int left_of = 0, right_of = 0;
  for (int k = 0; k < 3; ++k) {
    const Vec2 &p = corner[k], &q = corner[(k + 1) % 3];
    const double turn = p.x() * q.y() - p.y() * q.x();
    left_of += turn > kRounding * far * far, right_of += turn < -kRounding * far * far;
  }
  if (left_of > 0 && right_of > 0) return 0;
  return left_of == 3 || right_of == 3 ? 1 : 2;
}

bool are_apart(const Mesh& mesh, int i, int j) {
  const Triangle &a = mesh.triangles[i], &b = mesh.triangles[j];
  int shared = 0, at_a = 0, at_b = 0;
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < 3; ++l) {
      if (a[k] != b[l]) continue;
      ++shared, at_a = k, at_b = l;
    }
  if (shared > 1) return false;
  if (shared == 1) return apart_at_corner(mesh, a, at_a, b, at_b) || apart_at_corner(mesh, b, at_b, a, at_a);
  const Vec3& origin = mesh.positions[a[0]];
  std::array<Vec3, 3> p, q;
  double far = 0;
  for (int k = 0; k < 3; ++k) {
    p[k] = mesh.positions[a[k]] - origin, q[k] = mesh.positions[b[k]] - origin;
    far = std::max({far, reach(p[k]), reach(q[k])});
  }
  return apart(p, q, far) || apart(q, p, far);
}

}  // namespace carve
