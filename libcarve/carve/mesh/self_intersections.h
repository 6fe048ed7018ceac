#pragma once
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "carve/mesh/adjacency.h"
#include "carve/mesh/mesh.h"
#include "carve/mesh/triangle_grid.h"

namespace carve {

/// Pairs (i < j, sorted) of triangles that meet elsewhere than in the corners and sides they share by index: crossing,
/// touching, overlapping or folded onto each other. Decided by exact predicates. Triangles without area are left out
/// (Topology::degenerate_triangles counts them). Seconds per million triangles: about 0.2.
/// \throws std::invalid_argument as check_mesh, or on a coordinate beyond 1e100
std::vector<std::pair<int, int>> self_intersections(const Mesh& mesh);

/// Only the pairs in which a triangle has a vertex whose `moved` is not 0; all if `moved` is empty.
/// \param around  vertex_triangles(mesh)
/// \param as_floats  also those that meet once coordinates are rounded to floats, as GLB and STL files hold them
std::vector<std::pair<int, int>> self_intersections(const Mesh& mesh, const VertexTriangles& around,
                                                    std::span<const std::uint8_t> moved = {}, bool as_floats = false);

/// Only the pairs with a triangle around one of `vertices`, in time that depends on how many these are.
/// \param grid  of the mesh, from before vertices moved to where they are now
std::vector<std::pair<int, int>> self_intersections(const Mesh& mesh, const VertexTriangles& around,
                                                    const TriangleGrid& grid, std::span<const int> vertices,
                                                    bool as_floats = false);

/// Those of the pairs that are mere contact: triangles without a common vertex that have a single point in common.
/// Surfaces that pass through each other have whole lines in common in some pair.
std::vector<std::pair<int, int>> contacts(const Mesh& mesh, std::span<const std::pair<int, int>> meeting);

}  // namespace carve
