#pragma once
// Internal to carve/refine: one round of fit() as a least-squares problem, solved by Ceres.
#include <cstdint>
#include <vector>

#include "carve/core/vector.h"

namespace carve::refining {

/// A vertex that a view's outline pulls at or holds back.
struct OutlinePull {
  int vertex = 0;
  double distance = 0;  // to the outline, positive outside
  double gain = 0;      // how the distance grows with the vertex's offset
  double weight = 0;    // of lying on the outline; 0: it only must not leave
};

/// Offsets of vertices along their normals. All lengths in units of the mesh's mean edge.
struct BendingProblem {
  std::vector<std::uint32_t> first;  // #V + 1: where each vertex's neighbours begin
  std::vector<int> neighbours;
  std::vector<Vec3> positions, normals;
  std::vector<double> curvature;   // wanted, see umbrella_curvature; not a number: any
  std::vector<std::uint8_t> held;  // 1: stays
  std::vector<OutlinePull> pulls;
  std::vector<double> stiffness;  // weight of curvature beside staying
};

/// Normal part of the way to the neighbours' mean over their mean squared distance: -1 / 2 R on a sphere of radius R
/// whose normals point outwards, however irregular the triangles.
double umbrella_curvature(const BendingProblem& problem, int vertex);

/// The offsets, one a vertex.
std::vector<double> solve(const BendingProblem& problem);

}  // namespace carve::refining
