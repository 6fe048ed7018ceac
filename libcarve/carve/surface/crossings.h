#pragma once
#include <vector>

#include "carve/core/raster.h"
#include "carve/grid/voxel_grid.h"
#include "carve/views/view_set.h"

namespace carve {

/// Where the drawn contours cross the grid edges of one view: per grid pixel, laid out as in grid/shadow.h, the
/// distance from the pixel's centre to the contour, in voxels in (0, 1), towards each of its four neighbours. Read only
/// where the pixel is inside and that neighbour is outside.
struct ViewCrossings {
  View view;
  Raster<float> right, left, up, down;
};

/// Empty: all crossings are in the middle.
struct Crossings {
  std::vector<ViewCrossings> views;
};

/// Marching intersections (thesis 3.1.4) \cite rocchini_2001: the exact crossing of each grid line with the drawn
/// contour, sub-pixel where the drawing's border is anti-aliased. A grid edge's vertex lies at the nearest of its
/// views' crossings.
Crossings contour_crossings(const ViewSet& views, const VoxelGrid& grid);

}  // namespace carve
