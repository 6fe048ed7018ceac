#pragma once
#include <utility>
#include <vector>

#include "carve/mesh/mesh.h"

namespace carve {

/// Pairs (i < j, sorted) of triangles that meet elsewhere than in the corners and sides they share by index: crossing,
/// touching, overlapping or folded onto each other. Decided by exact predicates. Triangles without area are left out
/// (Topology::degenerate_triangles counts them). \throws std::invalid_argument as build_bvh
std::vector<std::pair<int, int>> self_intersections(const Mesh& mesh);

}  // namespace carve
