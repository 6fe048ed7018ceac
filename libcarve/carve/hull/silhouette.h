#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "carve/views/frame.h"

namespace carve {

/// Lattice coordinates are integers in [0, kLattice]: the exact predicates of the hull fit 128 bits.
inline constexpr std::int32_t kLattice = 1 << 16;

/// (a, b): lattice coordinates along the axes (axis + 1) % 3 and (axis + 2) % 3 of a silhouette.
using LatticePoint = std::array<std::int32_t, 2>;
using LatticeLoop = std::vector<LatticePoint>;

/// What the object covers, seen along an axis of the world: a set of simple polygons with holes (and islands in them).
/// Loops have the inside on their left, a to the right and b upwards: outer ones run counter-clockwise, holes
/// clockwise. Loops may meet in single points; they must not cross or overlap.
struct Silhouette {
  int axis = 2;             // 0 = x, 1 = y, 2 = z
  View view = View::front;  // the first of the views that show it
  std::vector<LatticeLoop> loops;
};

/// Silhouettes along two or three axes on a common lattice; lattice point p lies at origin + unit * p in object units.
struct Silhouettes {
  std::vector<Silhouette> along;
  Vec3 origin = Vec3::Zero(), unit = Vec3::Constant(1.0 / kLattice);
};

}  // namespace carve
