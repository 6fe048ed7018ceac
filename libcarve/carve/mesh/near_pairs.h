#pragma once
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "carve/mesh/adjacency.h"
#include "carve/mesh/mesh.h"
#include "carve/mesh/triangle_grid.h"

namespace carve {

/// Pairs (i < j, sorted) of triangles that rounded arithmetic cannot prove to meet nowhere but in the corners and sides
/// they share by index: all that do meet elsewhere, and few others.
/// \param around  vertex_triangles(mesh)
/// \param moved  one a vertex: only pairs with a vertex that is not 0; empty: all
/// \param blur  by how much each coordinate may be off
/// \throws std::invalid_argument: a coordinate beyond 1e100
std::vector<std::pair<int, int>> near_pairs(const Mesh& mesh, const VertexTriangles& around,
                                            std::span<const std::uint8_t> moved = {}, double blur = 0);

/// Only pairs with a triangle around one of `vertices`, in time that depends on how many these are.
/// \param grid  of a mesh whose vertices moved to where they are now
std::vector<std::pair<int, int>> near_pairs(const Mesh& mesh, const VertexTriangles& around, const TriangleGrid& grid,
                                            std::span<const int> vertices, double blur = 0);

}  // namespace carve
