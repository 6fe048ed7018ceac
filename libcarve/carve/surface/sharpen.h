#pragma once
#include "carve/grid/voxel_grid.h"
#include "carve/surface/guides.h"

namespace carve {

/// Gives a marching-cubes mesh the edges and corners that its cells cut off, as extended marching cubes do
/// \cite kobbelt_2001. A cell whose vertices' normals differ by more than kFeatureAngle gets a vertex where their
/// planes meet (least squares), a fan around it instead of its triangles, and an edge to the same kind of vertex in a
/// neighbouring cell instead of the side they share.
///
/// Stays closed, oriented and 2-manifold, and no intersection of triangles arises: the new vertex lies strictly inside
/// its cell, so that its fan is a cone over a simple closed curve on the cell's sides, and an edge through a side only
/// bends that curve there. Cells with several sheets, or with a vertex that has no normal, stay as they are.
///
/// \param mesh  marching_cubes(grid, ...); new vertices come after its own, in the order of their cells
/// \param guides  vertex_guides(); gets those of the new vertices, along their edges or fixed
Mesh sharpen(const Mesh& mesh, const VoxelGrid& grid, Guides& guides);

inline constexpr double kFeatureAngle = 30;  // degrees

}  // namespace carve
