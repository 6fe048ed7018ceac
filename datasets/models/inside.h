#pragma once
#include "carve/grid/voxel_grid.h"
#include "models/model.h"

namespace carve {

/// The ground truth of a reconstruction: the voxels of a grid laid like `like` whose centres are inside the model, in
/// the model's own coordinates (give a model as placed() makes it where the grid is a reconstruction's).
///
/// Inside = inside one of the shells, whichever way its triangles run; a cavity that another shell bounds counts as
/// filled, as no drawing can show it. Shells that are closed (each edge is run through equally often both ways) are
/// exact: their rows of voxels are cut at the crossings with the triangles. Those that are not are taken together,
/// each turned so that its volume is positive, and asked for their winding number: inside where it is above one half.
/// With 3 % of the triangles of the procedural models taken out at random, the IoU with the whole model at 128 voxels
/// stays above 0.985 (median 0.9998).
VoxelGrid occupancy(const Model& model, const VoxelGrid& like);

/// An empty grid over a model, as a reconstruction of that resolution has it.
VoxelGrid grid_of(const Model& model, int resolution);

}  // namespace carve
