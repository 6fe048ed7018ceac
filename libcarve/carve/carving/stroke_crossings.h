#pragma once
#include <span>

#include "carve/carving/regions.h"
#include "carve/grid/edge_crossings.h"

namespace carve {

/// Marching intersections (thesis 3.1.4) \cite rocchini_2001 of what geometric consistency carved: its surface is a
/// stroke swept along a view's direction, so it crosses the grid edges where the regions' borders do. Of several views'
/// borders, those in views that see the carved side come before the others, then the nearest to the inside centre
/// counts. Edges that no border crosses have no entry.
/// \param kept  a part of the hull
/// \param views  drawn borders on the hull's grid
AxisCrossings stroke_crossings(const VoxelGrid& hull, const VoxelGrid& kept, std::span<const RegionBorders> views);

}  // namespace carve
