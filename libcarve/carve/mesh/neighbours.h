#pragma once
#include <array>
#include <vector>

#include "carve/mesh/mesh.h"

namespace carve {

/// Per triangle, the triangle beyond the edge from corner k to corner k + 1; -1 where no triangle runs along that edge
/// the other way. Of several (edges that are not manifold) the first.
std::vector<std::array<int, 3>> triangle_neighbours(const Mesh& mesh);

/// Unit normals; zero where a triangle has no area.
std::vector<Vec3> triangle_normals(const Mesh& mesh);

}  // namespace carve
