#include "models/winding.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace carve {
namespace {

constexpr int kLeaf = 8;
using Corners = std::array<Vec3, 3>;

Vec3 area_vector(const Corners& t) { return (t[1] - t[0]).cross(t[2] - t[0]) / 2; }
Vec3 middle(const Corners& t) { return (t[0] + t[1] + t[2]) / 3; }

// Signed solid angle (van Oosterom and Strackee), positive from inside.
double solid_angle(const Corners& t, const Vec3& p) {
  const Vec3 a = t[0] - p, b = t[1] - p, c = t[2] - p;
  const double x = a.norm(), y = b.norm(), z = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)), x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y);
}

}  // namespace

WindingNumber::WindingNumber(const Mesh& mesh, double accuracy) : accuracy_(accuracy) {
  for (const auto& [a, b, c] : mesh.triangles)
    corners_.push_back({mesh.positions[a], mesh.positions[b], mesh.positions[c]});
  if (!corners_.empty()) build(0, static_cast<int>(corners_.size()));
}

int WindingNumber::build(int first, int last) {
  const int index = static_cast<int>(nodes_.size());
  nodes_.push_back({Vec3::Zero(), Vec3::Zero(), 0, first, last, 0});
  Node node = nodes_.back();
  double area = 0;
  Vec3 low = middle(corners_[first]), high = low;
  for (int i = first; i < last; ++i) {
    const Vec3 vector = area_vector(corners_[i]), m = middle(corners_[i]);
    area += vector.norm();
    node.dipole += vector;
    node.centre += vector.norm() * m;
    low = low.cwiseMin(m), high = high.cwiseMax(m);
  }
  node.centre = area > 0 ? Vec3(node.centre / area) : low;
  for (int i = first; i < last; ++i)
    for (const Vec3& p : corners_[i]) node.radius = std::max(node.radius, (p - node.centre).norm());
  if (last - first > kLeaf) {
    int axis = 0;
    (high - low).maxCoeff(&axis);
    const int half = (first + last) / 2;
    std::nth_element(corners_.begin() + first, corners_.begin() + half, corners_.begin() + last,
                     [axis](const Corners& a, const Corners& b) { return middle(a)[axis] < middle(b)[axis]; });
    build(first, half);
    node.right = build(half, last);
  }
  nodes_[index] = node;
  return index;
}

double WindingNumber::sum(int index, const Vec3& point) const {
  const Node& node = nodes_[index];
  const Vec3 away = node.centre - point;
  const double distance = away.norm();
  if (distance > accuracy_ * node.radius && distance > 0)
    return node.dipole.dot(away) / (distance * distance * distance);
  if (node.right) return sum(index + 1, point) + sum(node.right, point);
  double angles = 0;
  for (int i = node.first; i < node.last; ++i) angles += solid_angle(corners_[i], point);
  return angles;
}

double WindingNumber::operator()(const Vec3& point) const {
  return nodes_.empty() ? 0 : sum(0, point) / (4 * std::numbers::pi);
}

}  // namespace carve
