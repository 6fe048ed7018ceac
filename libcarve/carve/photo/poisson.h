#pragma once
#include "carve/core/monitor.h"
#include "carve/grid/voxel_grid.h"
#include "carve/mesh/mesh.h"
#include "carve/photo/stereo.h"

namespace carve {

/// A closed surface through oriented points \cite kazhdan_2006: CGAL's Poisson function, negative inside, on the
/// centres of a grid laid like `region`, and marching cubes with the vertices where the function is zero. Closed,
/// oriented and 2-manifold whatever the points; holes in them are spanned. What leaves the region is cut off there.
/// Of points in a cube of a quarter voxel the first is used. \throws NoResult if fewer than 1100 are left in the region
/// (of so few CGAL makes noise), or if they make no surface
Mesh poisson_surface(const OrientedPoints& points, const VoxelGrid& region, const Monitor& monitor = {});

}  // namespace carve
