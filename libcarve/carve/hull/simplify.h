#pragma once
#include "carve/hull/silhouette.h"

namespace carve::hull {

/// Loops with fewer vertices, all of them vertices of the loops given, which stay within `tolerance` of those vertices
/// that were left out, measured in units of scale[0] and scale[1] lattice units. Topology is kept: no loop vanishes,
/// crosses another or changes its side \cite dyken_2009. Vertices on the border of the loops' box stay, so its extents
/// do.
std::vector<LatticeLoop> simplified(const std::vector<LatticeLoop>& loops, double tolerance,
                                    const std::array<double, 2>& scale);

}  // namespace carve::hull
