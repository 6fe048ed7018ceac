#pragma once
#include <functional>
#include <span>

#include "models/model.h"

namespace carve {

/// Closed, outward oriented shells, the parts that procedural models are put together from.
Mesh box(const Vec3& low, const Vec3& high);
/// Edges and corners rounded with `radius`.
Mesh rounded_box(const Vec3& low, const Vec3& high, double radius, int segments = 5);
Mesh ellipsoid(const Vec3& centre, const Vec3& radii, int segments = 48);
/// From a to b, the radius changing from ra to rb (0: a point).
Mesh cone(const Vec3& a, const Vec3& b, double ra, double rb, int segments = 48);
inline Mesh cylinder(const Vec3& a, const Vec3& b, double radius, int segments = 48) {
  return cone(a, b, radius, radius, segments);
}
/// Turns (radius, height) points around the y axis; the first and the last have radius 0.
Mesh lathe(std::span<const Vec2> profile, int segments = 64);
Mesh torus(const Vec3& centre, int axis, double ring, double tube, int segments = 64);
/// A simple polygon in the plane of the two axes after `axis` (z, x for y), extruded along it.
Mesh prism(std::span<const Vec2> polygon, int axis, double low, double high);
/// Joins rings of equally many points; both ends are closed by fans around the ends' centroids.
Mesh loft(std::span<const std::vector<Vec3>> rings);
/// A tube along a path with one radius a point and rounded ends.
Mesh tube(std::span<const Vec3> path, std::span<const double> radii, int segments = 24);
/// Superellipses |u/a|^e + |v/b|^e = 1 across `axis` (u, v: the two axes after it), one a section.
struct Section {
  Vec3 centre;
  double a, b;
  double exponent = 2;
};
Mesh body(std::span<const Section> sections, int axis, int segments = 48);
/// Where `field` (negative inside) is 0, by marching tetrahedra; the field must be positive on the box's faces.
Mesh polygonise(const std::function<double(const Vec3&)>& field, const Vec3& low, const Vec3& high, double spacing);

Mesh moved(Mesh mesh, const Vec3& by);
Mesh turned(Mesh mesh, int axis, double degrees, const Vec3& around = Vec3::Zero());  // right-handed
Mesh mirrored(Mesh mesh, int axis);                                                   // stays outward oriented
/// A catmull-rom curve through the points, `steps` points a piece.
std::vector<Vec3> curve(std::span<const Vec3> points, int steps = 8);

/// Adds a part in the material of that name, which is made on first use.
void add(Model& model, const char* material, Rgba colour, const Mesh& part);

}  // namespace carve
