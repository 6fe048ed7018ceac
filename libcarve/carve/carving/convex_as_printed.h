#pragma once
#include "carve/grid/voxel_grid.h"
#include "carve/views/view_set.h"

namespace carve {

/// Algorithm 3.5 of \cite silva_2018 as it is printed, in the reading of papers/notes/silva_2018.md: every slice across
/// a drawing whose silhouette is convex is cut by that silhouette, scaled to the slice's box. Nothing keeps the other
/// silhouettes.
VoxelGrid refine_convex_as_printed(const VoxelGrid& solid, const ViewSet& views);

}  // namespace carve
