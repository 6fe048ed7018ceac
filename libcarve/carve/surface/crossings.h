#pragma once
#include "carve/core/raster.h"
#include "carve/grid/edge_crossings.h"
#include "carve/grid/voxel_grid.h"
#include "carve/views/view_set.h"

namespace carve {

/// Where the drawn outlines cross the grid lines of one coordinate plane, by voxel index. Entry (i, j) of `first` lies
/// on the line along the plane's first axis between the centres (i - 1, j) and (i, j), entry (i, j) of `second` along
/// its second axis between (i, j - 1) and (i, j); the outermost entries reach half out of the grid. The value is the
/// distance from the drawn object's side to the outline, in voxels in (0, 1): positive if the lower centre lies in the
/// object and the upper one outside, negative if it is the other way round, 0 if the views see no outline there.
struct PlaneCrossings {
  Raster<float> first, second;
};

/// One plane for front and back (xy), top and bottom (xz), side and left (yz). Empty planes see no outline.
struct Crossings {
  PlaneCrossings xy, xz, yz;
  AxisCrossings edges = {};    // of surfaces that no outline shows; the nearest of all is taken
  AxisCrossings strokes = {};  // of surfaces that were carved along strokes: these stay flat and sharp
};

/// Marching intersections (thesis 3.1.4) \cite rocchini_2001: the exact crossing of each grid line with the drawn
/// outline (image/outline.h), the first one seen from the inside centre, at least kClearance off the centres. Inside is
/// taken at the voxels' centres: grids carved with Patch::any have surfaces beyond these outlines, and there the
/// crossings say nothing.
Crossings contour_crossings(const ViewSet& views, const VoxelGrid& grid);

}  // namespace carve
