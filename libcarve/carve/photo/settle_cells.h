#pragma once
#include "carve/carving/geometric_consistency.h"
#include "carve/photo/space_carving.h"

namespace carve {

/// What photos made of the cells that drawings leave open.
struct SettledCells {
  VoxelGrid grid;
  int kept = 0, dropped = 0;  // of the open cells that `solid` has
};

/// Photo-consistency settles what several solids explain equally well (the combination that \cite silva_2018 proposes,
/// 5.2): Space Carving \cite kutulakos_2000 of the open cells alone. A cell that was kept goes if it loses more than
/// half of its voxels to silhouettes and colours, else it stays whole; nothing else changes. Cells that were dropped
/// stay so: what Space Carving leaves is no evidence that something is there, where photos see little or nothing of it.
/// \throws as space_carving; std::invalid_argument if a cell does not lie in the grid
SettledCells settle_cells(std::span<const Photo> photos, const VoxelGrid& solid, std::span<const OpenCell> cells,
                          const SpaceCarvingOptions& options = {}, const Monitor& monitor = {});

}  // namespace carve
