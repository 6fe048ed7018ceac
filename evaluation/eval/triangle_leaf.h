#pragma once
#include <Eigen/Geometry>
#include <algorithm>

#include "carve/core/vector.h"

// Vectors are passed between inlined functions only, so their calling convention never shows.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace carve::kernel {

using Float8 = float __attribute__((vector_size(32)));

// Eight triangles, each in its own plane: corner a is the origin, b lies on the first axis at `b`, c above it.
struct alignas(64) TriangleLeaf {
  Float8 origin[3], u[3], v[3], n[3];  // the plane's frame
  Float8 b;                            // length of ab
  Float8 ac[2], ac_length;             // unit direction from a to c
  Float8 bc[2], bc_length;             // unit direction from b to c
};

inline Vec3 unit_or(const Vec3& v, const Vec3& otherwise) {
  const double length = v.norm();
  return length > 0 ? Vec3(v / length) : otherwise;
}

inline Vec3 any_perpendicular(const Vec3& u) {
  int smallest;
  u.cwiseAbs().minCoeff(&smallest);
  return u.cross(Vec3::Unit(smallest)).normalized();
}

inline void store_triangle(TriangleLeaf& leaf, int lane, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = unit_or(b - a, unit_or(c - a, Vec3::UnitX()));
  Vec3 rise = (c - a) - (c - a).dot(u) * u;
  // Twice is enough: where little is left of a sliver's height, what is left must still be perpendicular.
  rise -= rise.dot(u) * u;
  const Vec3 v = rise.norm() > 1e-14 ? rise.normalized() : any_perpendicular(u);
  const Vec3 n = u.cross(v);
  for (int k = 0; k < 3; ++k) {
    leaf.origin[k][lane] = static_cast<float>(a[k]);
    leaf.u[k][lane] = static_cast<float>(u[k]);
    leaf.v[k][lane] = static_cast<float>(v[k]);
    leaf.n[k][lane] = static_cast<float>(n[k]);
  }
  const double length = (b - a).dot(u);
  const Vec2 ac((c - a).dot(u), std::max(0.0, (c - a).dot(v))), bc = ac - Vec2(length, 0);
  const Vec2 ac_unit = ac.norm() > 0 ? Vec2(ac.normalized()) : Vec2(Vec2::UnitX());
  const Vec2 bc_unit = bc.norm() > 0 ? Vec2(bc.normalized()) : Vec2(Vec2::UnitX());
  leaf.b[lane] = static_cast<float>(length);
  leaf.ac_length[lane] = static_cast<float>(ac.norm());
  leaf.bc_length[lane] = static_cast<float>(bc.norm());
  for (int k = 0; k < 2; ++k) {
    leaf.ac[k][lane] = static_cast<float>(ac_unit[k]);
    leaf.bc[k][lane] = static_cast<float>(bc_unit[k]);
  }
}

[[gnu::always_inline]] inline Float8 all(float x) { return x - Float8{}; }
[[gnu::always_inline]] inline Float8 clamp(const Float8& x, const Float8& high) {
  const Float8 zero{};
  const Float8 low = x < zero ? zero : x;
  return low > high ? high : low;
}

/// Squared distances of a point, given eight times over, to the leaf's triangles.
[[gnu::always_inline]] inline Float8 squared_distances(const TriangleLeaf& leaf, const Float8& px, const Float8& py,
                                                       const Float8& pz) {
  const Float8 zero{};
  const Float8 ax = px - leaf.origin[0], ay = py - leaf.origin[1], az = pz - leaf.origin[2];
  const Float8 x = ax * leaf.u[0] + ay * leaf.u[1] + az * leaf.u[2];
  const Float8 y = ax * leaf.v[0] + ay * leaf.v[1] + az * leaf.v[2];
  const Float8 z = ax * leaf.n[0] + ay * leaf.n[1] + az * leaf.n[2];
  const Float8 ab_gap = x - clamp(x, leaf.b);
  Float8 side = ab_gap * ab_gap + y * y;
  const Float8 t_ac = clamp(x * leaf.ac[0] + y * leaf.ac[1], leaf.ac_length);
  const Float8 ac_x = x - t_ac * leaf.ac[0], ac_y = y - t_ac * leaf.ac[1];
  const Float8 ac_side = ac_x * ac_x + ac_y * ac_y;
  side = ac_side < side ? ac_side : side;
  const Float8 bx = x - leaf.b;
  const Float8 t_bc = clamp(bx * leaf.bc[0] + y * leaf.bc[1], leaf.bc_length);
  const Float8 bc_x = bx - t_bc * leaf.bc[0], bc_y = y - t_bc * leaf.bc[1];
  const Float8 bc_side = bc_x * bc_x + bc_y * bc_y;
  side = bc_side < side ? bc_side : side;
  // Not y >= 0: a triangle that is a point or a segment has no inside, and on the line of a and b the side tells.
  const auto inside = (y > zero) & (leaf.ac[0] * y <= leaf.ac[1] * x) & (leaf.bc[0] * y >= leaf.bc[1] * bx);
  return z * z + (inside ? zero : side);
}

}  // namespace carve::kernel
