#pragma once
#include <vector>

#include "carve/mesh/mesh.h"

namespace carve {

/// Which shell each triangle is of: triangles that share a vertex are of one; numbered in order of their first
/// triangle.
std::vector<int> shell_indices(const Mesh& mesh);

/// Corners at one place become one, so that the shells of texture-split meshes hang together. Triangles that lose a
/// corner so and vertices without a triangle go.
Mesh welded(const Mesh& mesh);

/// One mesh a shell, without unused vertices.
std::vector<Mesh> shells(const Mesh& mesh);

/// Each edge is run through equally often both ways: the winding number is whole everywhere.
bool winds_whole(const Mesh& mesh);

}  // namespace carve
