#pragma once
#include "carve/mesh/mesh.h"

namespace carve {

/// Volume of the intersection of two closed meshes over that of their union, in [0, 1]; 0 if both are empty.
///
/// Both are filled on one grid over their common box, `resolution` cubes along its longest side, sampled at the cubes'
/// centres. A centre is inside where the winding number, counted by signed crossings of a row along x, is not 0: shells
/// that interpenetrate count once, reversed inner shells are cavities. The error falls as 1 / resolution.
/// \throws std::invalid_argument if resolution is not in [1, 2048]
double volume_iou(const Mesh& a, const Mesh& b, int resolution);

}  // namespace carve
