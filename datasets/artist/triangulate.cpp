#include "artist/triangulate.h"

#include <Eigen/Geometry>
#include <numeric>

namespace carve::artist {
namespace {

double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

bool inside(const Vec2& p, const Vec2& a, const Vec2& b, const Vec2& c) {
  return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0 && p != a && p != b && p != c;
}

std::vector<Vec2> flatten(std::span<const Vec3> outline) {
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 0; i < outline.size(); ++i)
    normal += (outline[i] - outline[0]).cross(outline[(i + 1) % outline.size()] - outline[0]);
  const Vec3 across = normal.unitOrthogonal(), up = normal.normalized().cross(across);
  std::vector<Vec2> flat;
  for (const Vec3& p : outline) flat.push_back({(p - outline[0]).dot(across), (p - outline[0]).dot(up)});
  return flat;
}

}  // namespace

std::vector<std::array<int, 3>> triangulate(std::span<const Vec3> outline) {
  if (outline.size() == 3) return {{0, 1, 2}};
  const std::vector<Vec2> flat = flatten(outline);
  std::vector<int> ring(outline.size());
  std::iota(ring.begin(), ring.end(), 0);
  std::vector<std::array<int, 3>> triangles;
  while (ring.size() > 3) {
    const int n = static_cast<int>(ring.size());
    int ear = 1;  // if rounding leaves no ear, any corner will do
    for (int i = 1; i <= n; ++i) {
      const int a = ring[i - 1], b = ring[i % n], c = ring[(i + 1) % n];
      if (turn(flat[a], flat[b], flat[c]) <= 0) continue;
      bool empty = true;
      for (const int p : ring)
        if (p != a && p != b && p != c && inside(flat[p], flat[a], flat[b], flat[c])) empty = false;
      if (!empty) continue;
      ear = i;
      break;
    }
    triangles.push_back({ring[ear - 1], ring[ear % n], ring[(ear + 1) % n]});
    ring.erase(ring.begin() + ear % n);
  }
  triangles.push_back({ring[0], ring[1], ring[2]});
  return triangles;
}

}  // namespace carve::artist
