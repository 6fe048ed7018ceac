#pragma once
#include "carve/grid/voxel_grid.h"
#include "carve/mesh/mesh.h"
#include "carve/surface/crossings.h"

namespace carve {

/// The isosurface between voxel centres inside and outside \cite lorensen_1987, over the active cells only.
///
/// Closed, oriented and 2-manifold for every grid: the grid is taken as surrounded by empty voxels, an ambiguous face
/// always separates its two inside corners, and no triangle's inner edge lies on a cell's face. A vertex lies on the
/// grid edge between an inside and an outside centre: in its middle, or where `crossings` puts it. Vertices and
/// triangles come in scan order of their cells (x fastest, then y), whatever the thread count.
/// \throws std::invalid_argument if the crossings are of a grid of another size; std::length_error if the mesh would
/// have more vertices than Triangle's indices can name
Mesh marching_cubes(const VoxelGrid& grid, const Crossings& crossings = {});

}  // namespace carve
