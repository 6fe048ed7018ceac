#pragma once
#include "carve/core/raster.h"
#include "carve/grid/voxel_grid.h"
#include "carve/views/frame.h"

namespace carve {

/// Which voxels lie behind a pixel of a view at the grid's resolution, layer by layer from the viewer's side.
struct ShadowLayout {
  Frame frame;
  int width = 0, height = 0, depth = 0;  // voxels along the view's right, up and toward axes

  ShadowLayout(const Vec3i& size, View view)
      : frame(carve::frame(view)),
        width(size[frame.right.axis]),
        height(size[frame.up.axis]),
        depth(size[frame.toward.axis]) {}
  int right_index(int i) const { return frame.right.sign > 0 ? i : width - 1 - i; }    // pixel column <-> voxel index
  int up_index(int j) const { return frame.up.sign > 0 ? height - 1 - j : j; }         // pixel row <-> voxel index
  int toward_index(int d) const { return frame.toward.sign > 0 ? depth - 1 - d : d; }  // layer <-> voxel index
};

/// The grid seen along a view: one pixel a voxel column, image right and up as in the view's frame (row 0 on top).
/// Pixel (i, j) belongs to the voxels whose index along `right` is i (counted backwards if its sign is -1) and along
/// `up` is height - 1 - j (likewise).
Mask shadow(const VoxelGrid& grid, View view);

/// Voxels between the box's face on the viewer's side and the first voxel inside, per pixel; -1 where none is inside.
Raster<int> depth(const VoxelGrid& grid, View view);

}  // namespace carve
