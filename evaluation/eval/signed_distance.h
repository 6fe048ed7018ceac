#pragma once
#include <span>
#include <vector>

#include "eval/mesh_distance.h"

namespace carve {

/// How the side of a point is told; positive = outside = where counter-clockwise triangles face.
enum class SignRule {
  /// The angle-weighted pseudo-normal of the nearest face, edge or corner \cite baerentzen_2005: right for every point
  /// of a closed, oriented manifold.
  pseudo_normal,
  /// The normal of the nearest triangle, the lowest index among equals. CloudCompare's rule, which takes whichever of
  /// the equals its octree meets first: both are arbitrary where an edge or a corner is nearest.
  nearest_face
};
inline std::span<const char* const> names(SignRule) {
  static constexpr const char* all[] = {"pseudo_normal", "nearest_face"};
  return all;
}

/// The answers `nearest` to `points` with their signs. Corners at equal positions count as one, so a triangle soup
/// (STL) has the signs of the mesh it shows.
std::vector<double> signed_distances(std::span<const Vec3> points, std::span<const Nearest> nearest, const Mesh& mesh,
                                     SignRule rule = SignRule::pseudo_normal);

}  // namespace carve
