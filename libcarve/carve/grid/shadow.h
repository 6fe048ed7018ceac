#pragma once
#include "carve/core/raster.h"
#include "carve/grid/voxel_grid.h"
#include "carve/views/frame.h"

namespace carve {

/// The grid seen along a view: one pixel a voxel column, image right and up as in the view's frame (row 0 on top).
/// Pixel (i, j) belongs to the voxels whose index along `right` is i (counted backwards if its sign is -1) and along
/// `up` is height - 1 - j (likewise).
Mask shadow(const VoxelGrid& grid, View view);

/// Voxels between the box's face on the viewer's side and the first voxel inside, per pixel; -1 where none is inside.
Raster<int> depth(const VoxelGrid& grid, View view);

}  // namespace carve
