#pragma once
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "carve/core/vector.h"

namespace carve {

/// What a triangle's texture coordinates (v down) make of its own plane, per model unit; a positive determinant lays it
/// face up. Its symmetric Dirichlet energy is the squared norm of this and of the inverse; 4 = isometric.
inline Eigen::Matrix2d uv_jacobian(const Vec3& a, const Vec3& b, const Vec3& c, const Vec2& at_a, const Vec2& at_b,
                                   const Vec2& at_c) {
  const Vec3 p = b - a, q = c - a;
  const Vec3 x = p.normalized(), y = p.cross(q).cross(p).normalized();
  const Vec2 u = at_b - at_a, v = at_c - at_a;
  Eigen::Matrix2d world, texture;
  world << p.dot(x), q.dot(x), p.dot(y), q.dot(y);
  texture << u.x(), v.x(), -u.y(), -v.y();
  return texture * world.inverse();
}

}  // namespace carve
