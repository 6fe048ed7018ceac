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

/// How far lengths of up to `far` may be off.
double clear(double far, double blur) { return kRounding * far + 64 * blur; }

/// Whether triangles `a` and `b`, given as differences from one point, lie on two sides of a plane across `axis`.
bool apart_along(const Vec3& axis, const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double far,
                 double blur) {
  const double slack = axis.cwiseAbs().sum() * clear(far, blur);
  const auto [a_low, a_high] = std::minmax({axis.dot(a[0]), axis.dot(a[1]), axis.dot(a[2])});
  const auto [b_low, b_high] = std::minmax({axis.dot(b[0]), axis.dot(b[1]), axis.dot(b[2])});
  return a_high + slack < b_low || b_high + slack < a_low;
}

/// Whether a plane along triangle `a` or across it through one of its sides separates it from `b`.
bool apart(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double far, double blur) {
  const Vec3 normal = (a[1] - a[0]).cross(a[2] - a[0]);
  if (apart_along(normal, a, b, far, blur)) return true;
  for (int k = 0; k < 3; ++k)
    if (apart_along(normal.cross(a[(k + 1) % 3] - a[k]), a, b, far, blur)) return true;
  return false;
}

/// Whether `b` lies on one side of the plane of `a`, but for the corner they share.
bool apart_at_corner(const Mesh& mesh, const Triangle& a, int at_a, const Triangle& b, int at_b, double blur) {
  const Vec3& origin = mesh.positions[a[at_a]];
  const auto from_corner = [&](const Triangle& t, int k) { return Vec3(mesh.positions[t[k % 3]] - origin); };
  const Vec3 p = from_corner(a, at_a + 1), q = from_corner(a, at_a + 2);
  const Vec3 r = from_corner(b, at_b + 1), s = from_corner(b, at_b + 2);
  const Vec3 normal = p.cross(q);
  const double far = std::max({reach(p), reach(q), reach(r), reach(s)}), least = far * far * clear(far, blur);
  const double side_r = normal.dot(r), side_s = normal.dot(s);
  return (side_r > least && side_s > least) || (side_r < -least && side_s < -least);
}

}  // namespace

bool is_plain(const Mesh& mesh, std::span<const int> star, int vertex, double blur) {
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
  const double least = sum.cwiseAbs().sum() * far * clear(far, blur);
  for (std::size_t i = 0; i < star.size(); ++i)
    if (!(sum.dot(normal[i]) > least)) return false;
  // Once around: one step over a ray that ends in the vertex. In lattices this one passes between the others.
  const Vec3 across = sum.cross(0.62 * ahead[0] + 0.38 * ahead[next[0]]);
  const double aside = across.cwiseAbs().sum() * clear(far, blur);
  std::array<double, kMost> side;
  for (std::size_t i = 0; i < star.size(); ++i) {
    side[i] = across.dot(ahead[i]);
    if (!(std::abs(side[i]) > aside)) return false;
  }
  int turns = 0;
  for (std::size_t i = 0; i < star.size(); ++i) turns += side[i] < 0 && side[next[i]] > 0;
  return turns == 1;
}

Vec3i faces(const Vec3& a, const Vec3& b, const Vec3& c, double blur) {
  const Vec3 u = b - a, v = c - a, normal = u.cross(v);
  const double far = std::max(reach(u), reach(v)), least = far * clear(far, blur);
  Vec3i signs;
  for (int k = 0; k < 3; ++k) signs[k] = (normal[k] > least) - (normal[k] < -least);
  return signs;
}

int crossings(const Mesh& mesh, int triangle, const Vec3& point, int axis, double blur) {
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
    left_of += turn > far * clear(far, blur), right_of += turn < -far * clear(far, blur);
  }
  if (left_of > 0 && right_of > 0) return 0;
  return left_of == 3 || right_of == 3 ? 1 : 2;
}

bool are_apart(const Mesh& mesh, int i, int j, double blur) {
  const Triangle &a = mesh.triangles[i], &b = mesh.triangles[j];
  int shared = 0, at_a = 0, at_b = 0;
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < 3; ++l) {
      if (a[k] != b[l]) continue;
      ++shared, at_a = k, at_b = l;
    }
  if (shared > 1) return false;
  if (shared == 1)
    return apart_at_corner(mesh, a, at_a, b, at_b, blur) || apart_at_corner(mesh, b, at_b, a, at_a, blur);
  const Vec3& origin = mesh.positions[a[0]];
  std::array<Vec3, 3> p, q;
  double far = 0;
  for (int k = 0; k < 3; ++k) {
    p[k] = mesh.positions[a[k]] - origin, q[k] = mesh.positions[b[k]] - origin;
    far = std::max({far, reach(p[k]), reach(q[k])});
  }
  return apart(p, q, far, blur) || apart(q, p, far, blur);
}

}  // namespace carve
