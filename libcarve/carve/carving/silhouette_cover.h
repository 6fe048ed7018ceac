#pragma once
#include <span>

#include "carve/grid/voxel_grid.h"
#include "carve/views/frame.h"

namespace carve {

/// Gives back as few of the hull's voxels as it takes for the solid to cast the hull's shadow in every view. A pixel
/// without a voxel gets the one of its ray that closes most other such pixels, then the one with most neighbours in the
/// solid. \pre contains(hull, solid)
VoxelGrid cover_silhouettes(VoxelGrid solid, const VoxelGrid& hull, std::span<const View> views);

}  // namespace carve
