#pragma once
#include <span>

#include "carve/core/monitor.h"
#include "carve/grid/voxel_grid.h"
#include "carve/photo/camera.h"

namespace carve {

/// The visual hull of any number of photos \cite laurentini_1994 on a grid laid like `region`: the voxels of it whose
/// centres lie in the mask of every photo. A photo says nothing of what lies outside its picture or not before its
/// camera. Colours are not looked at. \throws std::invalid_argument if a mask is not as large as its camera's picture
VoxelGrid silhouette_hull(std::span<const Photo> photos, const VoxelGrid& region, const Monitor& monitor = {});

}  // namespace carve
