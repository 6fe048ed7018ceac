#pragma once
#include "carve/carving/carve_silhouettes.h"

namespace carve {

/// Algorithms 3.3 and 3.4 of \cite silva_2018, voxel by voxel, as far as the text determines them; the reading of each
/// open point is in papers/notes/silva_2018.md. Silhouettes may break.
VoxelGrid carve_as_printed(const Carving& hull);

}  // namespace carve
