#pragma once
#include <vector>

#include "carve/carving/patch_labels.h"
#include "carve/grid/voxel_grid.h"
#include "carve/views/view_set.h"

namespace carve {

struct CarveOptions {
  int grid = 128;
  Patch patch = Patch::centre;
};
template <class Visitor>
void visit_fields(CarveOptions& o, Visitor&& field) {
  field("grid", o.grid, 8, kLargestGrid, "voxels along the object's longest side");
  field("patch", o.patch, "which pixels of its patch make a voxel part of the object");
}

struct Carving {
  VoxelGrid grid;                  // Equation 3.1: voxels that every view shows as surface or edge
  std::vector<PatchLabels> views;  // in the order of the view set: V^s and V^b are their kSurface and kEdge bits
};

/// Silhouette carving, Algorithms 3.1 and 3.2 of \cite silva_2018: the discrete visual hull \cite laurentini_1994, with
/// the three labels kept per view. Strokes count as the object. \throws std::invalid_argument on an option out of
/// range; NoResult if no voxel is left
Carving carve_silhouettes(const ViewSet& views, const CarveOptions& options = {});

}  // namespace carve
