#pragma once
#include <vector>

#include "carve/grid/voxel_grid.h"
#include "carve/views/view_set.h"

namespace carve {

/// How well a solid explains one drawing. Drawings that disagree are reported here; they are not an error.
struct ViewAgreement {
  View view;
  double silhouette_iou = 0;   // of the drawing's silhouette and the solid's shadow, at the grid's resolution
  std::int64_t uncovered = 0;  // grid pixels that the drawing shows and no voxel reaches
  std::int64_t extra = 0;      // grid pixels that a voxel reaches and the drawing leaves empty
};

std::vector<ViewAgreement> agreement(const VoxelGrid& solid, const ViewSet& views);

}  // namespace carve
