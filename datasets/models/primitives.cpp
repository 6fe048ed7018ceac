#include "models/primitives.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace carve {
namespace {

constexpr double kPi = std::numbers::pi;

double signed_volume(const Mesh& mesh) {
  double volume = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    volume += mesh.positions[a].dot(mesh.positions[b].cross(mesh.positions[c])) / 6;
  return volume;
}

Mesh outward(Mesh mesh) {
  if (signed_volume(mesh) < 0)
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

Vec3 across(int axis, double along, double u, double v) {
  Vec3 p;
  p[axis] = along;
  p[(axis + 1) % 3] = u;
  p[(axis + 2) % 3] = v;
  return p;
}

// Fans of a ring around its centroid.
void close_end(Mesh& mesh, int first, int count, bool reversed) {
  Vec3 centroid = Vec3::Zero();
  for (int i = 0; i < count; ++i) centroid += mesh.positions[first + i] / count;
  const int tip = static_cast<int>(mesh.positions.size());
  mesh.positions.push_back(centroid);
  for (int i = 0; i < count; ++i) {
    const int a = first + i, b = first + (i + 1) % count;
    mesh.triangles.push_back(reversed ? Triangle{tip, b, a} : Triangle{tip, a, b});
  }
}

double cross2(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

// Ear clipping of a counter-clockwise simple polygon.
std::vector<Triangle> triangulated(std::span<const Vec2> polygon) {
  std::vector<int> left(polygon.size());
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = static_cast<int>(i);
  std::vector<Triangle> triangles;
  while (left.size() > 2) {
    const std::size_t n = left.size();
    std::size_t ear = n;
    for (std::size_t i = 0; i < n && ear == n; ++i) {
      const Vec2 &a = polygon[left[(i + n - 1) % n]], &b = polygon[left[i]], &c = polygon[left[(i + 1) % n]];
      if (cross2(b - a, c - b) <= 0) continue;
      const bool holds_another = std::any_of(left.begin(), left.end(), [&](int k) {
        const Vec2& p = polygon[k];
        return p != a && p != b && p != c && cross2(b - a, p - a) >= 0 && cross2(c - b, p - b) >= 0 &&
               cross2(a - c, p - c) >= 0;
      });
      if (!holds_another) ear = i;
    }
    if (ear == n) throw std::invalid_argument("prism: the polygon must be simple");
    triangles.push_back({left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  return triangles;
}

// A circle of radius r in the plane across `direction`; `u` is kept close to `reference` so that rings do not twist.
std::vector<Vec3> circle(const Vec3& centre, const Vec3& direction, const Vec3& reference, double r, int segments) {
  const Vec3 u = (reference - direction * direction.dot(reference)).normalized();
  const Vec3 v = direction.cross(u);
  std::vector<Vec3> ring(segments);
  for (int i = 0; i < segments; ++i) {
    const double angle = 2 * kPi * i / segments;
    ring[i] = centre + r * (std::cos(angle) * u + std::sin(angle) * v);
  }
  return ring;
}

Vec3 any_across(const Vec3& direction) {
  int smallest = 0;
  direction.cwiseAbs().minCoeff(&smallest);
  return Vec3::Unit(smallest);
}

}  // namespace

Mesh loft(std::span<const std::vector<Vec3>> rings) {
  Mesh mesh;
  const int n = static_cast<int>(rings.front().size());
  for (const auto& ring : rings) mesh.positions.insert(mesh.positions.end(), ring.begin(), ring.end());
  for (int k = 0; k + 1 < static_cast<int>(rings.size()); ++k)
    for (int i = 0; i < n; ++i) {
      const int a = k * n + i, b = k * n + (i + 1) % n;
      mesh.triangles.push_back({a, b, b + n});
      mesh.triangles.push_back({a, b + n, a + n});
    }
  close_end(mesh, 0, n, true);
  close_end(mesh, static_cast<int>(rings.size() - 1) * n, n, false);
  return outward(std::move(mesh));
}

Mesh box(const Vec3& low, const Vec3& high) {
  const Vec2 polygon[] = {{low.z(), low.x()}, {high.z(), low.x()}, {high.z(), high.x()}, {low.z(), high.x()}};
  return prism(polygon, 1, low.y(), high.y());
}

Mesh rounded_box(const Vec3& low, const Vec3& high, double radius, int segments) {
  std::vector<std::vector<Vec3>> rings;
  // Sections along y: rounded rectangles that shrink towards the ends.
  const auto section = [&](double y, double inset) {
    const double corner = std::max(radius - inset, radius * 0.05);
    std::vector<Vec3> ring;
    for (int quarter = 0; quarter < 4; ++quarter)
      for (int i = 0; i <= segments; ++i) {
        const double angle = kPi / 2 * (quarter + static_cast<double>(i) / segments);
        const double z = quarter == 0 || quarter == 3 ? high.z() - inset - corner : low.z() + inset + corner;
        const double x = quarter < 2 ? high.x() - inset - corner : low.x() + inset + corner;
        ring.emplace_back(x + corner * std::sin(angle), y, z + corner * std::cos(angle));
      }
    rings.push_back(std::move(ring));
  };
  for (int i = 0; i <= segments; ++i) {
    const double angle = kPi / 2 * i / segments;
    section(low.y() + radius * (1 - std::sin(angle)), radius * (1 - std::cos(angle)));
  }
  std::reverse(rings.begin(), rings.end());
  for (int i = 0; i <= segments; ++i) {
    const double angle = kPi / 2 * i / segments;
    section(high.y() - radius * (1 - std::sin(angle)), radius * (1 - std::cos(angle)));
  }
  return loft(rings);
}

Mesh lathe(std::span<const Vec2> profile, int segments) {
  Mesh mesh;
  mesh.positions.emplace_back(0, profile.front().y(), 0);
  for (std::size_t k = 1; k + 1 < profile.size(); ++k)
    for (int i = 0; i < segments; ++i) {
      const double angle = 2 * kPi * i / segments;
      mesh.positions.emplace_back(profile[k].x() * std::sin(angle), profile[k].y(), profile[k].x() * std::cos(angle));
    }
  const int last = static_cast<int>(mesh.positions.size());
  mesh.positions.emplace_back(0, profile.back().y(), 0);
  for (int i = 0; i < segments; ++i) {
    const int j = (i + 1) % segments;
    mesh.triangles.push_back({0, 1 + j, 1 + i});
    mesh.triangles.push_back({last, last - segments + i, last - segments + j});
    for (int first = 1; first + segments < last; first += segments) {
      mesh.triangles.push_back({first + i, first + j, first + segments + j});
      mesh.triangles.push_back({first + i, first + segments + j, first + segments + i});
    }
  }
  return outward(std::move(mesh));
}

Mesh ellipsoid(const Vec3& centre, const Vec3& radii, int segments) {
  std::vector<Vec2> profile;
  const int half = segments / 2;
  for (int k = 0; k <= half; ++k) {
    const double angle = kPi * k / half;
    profile.emplace_back(k == 0 || k == half ? 0 : std::sin(angle), -std::cos(angle));
  }
  Mesh mesh = lathe(profile, segments);
  for (Vec3& p : mesh.positions) p = centre + radii.cwiseProduct(p);
  return mesh;
}

Mesh cone(const Vec3& a, const Vec3& b, double ra, double rb, int segments) {
  const Vec3 direction = (b - a).normalized(), u = any_across(direction);
  std::vector<std::vector<Vec3>> rings;
  Mesh mesh;
  if (ra > 0) rings.push_back(circle(a, direction, u, ra, segments));
  if (rb > 0) rings.push_back(circle(b, direction, u, rb, segments));
  if (rings.size() == 2) return loft(rings);
  mesh.positions = rings.front();
  close_end(mesh, 0, segments, false);
  mesh.positions.push_back(ra > 0 ? b : a);
  for (int i = 0; i < segments; ++i) mesh.triangles.push_back({segments + 1, (i + 1) % segments, i});
  return outward(std::move(mesh));
}

Mesh torus(const Vec3& centre, int axis, double ring, double tube, int segments) {
  Mesh mesh;
  const int n = segments, m = std::max(8, segments / 2);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const double a = 2 * kPi * i / n, b = 2 * kPi * j / m, r = ring + tube * std::cos(b);
      mesh.positions.push_back(centre + across(axis, tube * std::sin(b), r * std::cos(a), r * std::sin(a)));
      const int p = i * m + j, q = i * m + (j + 1) % m, s = (i + 1) % n * m + j, t = (i + 1) % n * m + (j + 1) % m;
      mesh.triangles.push_back({p, s, t});
      mesh.triangles.push_back({p, t, q});
    }
  return outward(std::move(mesh));
}

Mesh prism(std::span<const Vec2> polygon, int axis, double low, double high) {
  double area = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) area += cross2(polygon[i], polygon[(i + 1) % polygon.size()]);
  std::vector<Vec2> points(polygon.begin(), polygon.end());
  if (area < 0) std::reverse(points.begin(), points.end());
  const int n = static_cast<int>(points.size());
  Mesh mesh;
  for (const double along : {low, high})
    for (const Vec2& p : points) mesh.positions.push_back(across(axis, along, p.x(), p.y()));
  for (const auto& [a, b, c] : triangulated(points)) {
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({a + n, b + n, c + n});
  }
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    mesh.triangles.push_back({i, j, j + n});
    mesh.triangles.push_back({i, j + n, i + n});
  }
  return outward(std::move(mesh));
}

Mesh tube(std::span<const Vec3> path, std::span<const double> radii, int segments) {
  std::vector<std::vector<Vec3>> rings;
  const std::size_t n = path.size();
  Vec3 reference = any_across((path[1] - path[0]).normalized());
  const auto half_sphere = [&](std::size_t k, const Vec3& direction, bool start) {
    for (int i = 1; i <= 5; ++i) {
      const double angle = kPi / 2 * (start ? 6 - i : i) / 6;
      const Vec3 centre = path[k] + direction * radii[k] * std::sin(angle) * (start ? -1 : 1);
      rings.push_back(circle(centre, direction, reference, radii[k] * std::cos(angle), segments));
    }
  };
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3 direction = (path[std::min(k + 1, n - 1)] - path[k == 0 ? 0 : k - 1]).normalized();
    if (k == 0) half_sphere(k, direction, true);
    rings.push_back(circle(path[k], direction, reference, radii[k], segments));
    reference = (rings.back()[0] - path[k]).normalized();
    if (k + 1 == n) half_sphere(k, direction, false);
  }
  return loft(rings);
}

Mesh body(std::span<const Section> sections, int axis, int segments) {
  std::vector<std::vector<Vec3>> rings;
  for (const Section& s : sections) {
    std::vector<Vec3> ring;
    for (int i = 0; i < segments; ++i) {
      const double angle = 2 * kPi * (i + 0.5) / segments, c = std::cos(angle), d = std::sin(angle);
      const double u = s.a * std::copysign(std::pow(std::abs(c), 2 / s.exponent), c);
      const double v = s.b * std::copysign(std::pow(std::abs(d), 2 / s.exponent), d);
      ring.push_back(s.centre + across(axis, 0, u, v));
    }
    rings.push_back(std::move(ring));
  }
  return loft(rings);
}

Mesh moved(Mesh mesh, const Vec3& by) {
  for (Vec3& p : mesh.positions) p += by;
  return mesh;
}

Mesh turned(Mesh mesh, int axis, double degrees, const Vec3& around) {
  const double c = std::cos(degrees * kPi / 180), s = std::sin(degrees * kPi / 180);
  for (Vec3& p : mesh.positions) {
    const Vec3 q = p - around;
    const double u = q[(axis + 1) % 3], v = q[(axis + 2) % 3];
    p = around + across(axis, q[axis], c * u - s * v, s * u + c * v);
  }
  return mesh;
}

Mesh mirrored(Mesh mesh, int axis) {
  for (Vec3& p : mesh.positions) p[axis] = -p[axis];
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

std::vector<Vec3> curve(std::span<const Vec3> points, int steps) {
  std::vector<Vec3> path;
  const int n = static_cast<int>(points.size());
  for (int k = 0; k + 1 < n; ++k) {
    const Vec3 &a = points[std::max(k - 1, 0)], &b = points[k], &c = points[k + 1], &d = points[std::min(k + 2, n - 1)];
    for (int i = 0; i < steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      path.push_back(0.5 *
                     (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t + (3 * b - a - 3 * c + d) * t * t * t));
    }
  }
  path.push_back(points[n - 1]);
  return path;
}

void add(Model& model, const char* material, Rgba colour, const Mesh& part) {
  const auto found = std::find_if(model.materials.begin(), model.materials.end(),
                                  [&](const Material& m) { return m.name == material; });
  const int index = static_cast<int>(found - model.materials.begin());
  if (found == model.materials.end()) model.materials.push_back({material, colour});
  const int first = static_cast<int>(model.mesh.positions.size());
  model.mesh.positions.insert(model.mesh.positions.end(), part.positions.begin(), part.positions.end());
  for (const auto& [a, b, c] : part.triangles) {
    model.mesh.triangles.push_back({first + a, first + b, first + c});
    model.material.push_back(index);
  }
}

}  // namespace carve
