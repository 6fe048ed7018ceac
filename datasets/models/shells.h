#pragma once
#include <vector>

#include "carve/mesh/mesh.h"

namespace carve {

/// Which shell each triangle is of: triangles that share a vertex are of one; numbered in order of their first
/// triangle.
std::vector<int> shell_indices(const Mesh& mesh);

/// One mesh a shell, without unused vertices.
std::vector<Mesh> shells(const Mesh& mesh);

}  // namespace carve
