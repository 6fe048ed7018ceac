#pragma once
#include "carve/core/vector.h"

namespace carve {

/// Where on triangle abc the point nearest to a query lies.
enum class Feature { face, corner_a, corner_b, corner_c, edge_ab, edge_bc, edge_ca };

struct Footpoint {
  Vec3 point = Vec3::Zero();
  double squared_distance = 0;
  Feature feature = Feature::face;
};

/// The point of triangle abc nearest to p. Backward stable: its distance is that of a triangle whose corners moved by
/// a few units in the last place of its size, slivers and degenerate triangles included. A corner's own is exactly 0.
Footpoint closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace carve
