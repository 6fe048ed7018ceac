#pragma once
#include <span>
#include <vector>

#include "carve/grid/voxel_grid.h"
#include "carve/views/view_set.h"

namespace carve {

/// When the patch of pixels that a voxel covers in a drawing counts as the object.
enum class Patch {
  centre,  // the pixel at the voxel's centre does: the sampled visual hull, unbiased
  any      // any of its pixels does, as Algorithm 3.2 has it: keeps thin parts, inflates by up to half a voxel
};
inline std::span<const char* const> names(Patch) {
  static constexpr const char* all[] = {"centre", "any"};
  return all;
}

struct CarveOptions {
  int grid = 128;
  Patch patch = Patch::centre;
};
template <class Visitor>
void visit_fields(CarveOptions& o, Visitor&& field) {
  field("grid", o.grid, 8, kLargestGrid, "voxels along the object's longest side");
  field("patch", o.patch, "which pixels of its patch make a voxel part of the object");
}

/// What a voxel's patch shows (Algorithm 3.2), or-ed together.
enum PatchLabel : std::uint8_t { kBackground = 1, kSurface = 2, kEdge = 4 };

/// One drawing at the grid's resolution, laid out as in grid/shadow.h.
struct PatchLabels {
  View view;
  Raster<std::uint8_t> labels;  // PatchLabel bits of all pixels in the patch
  Mask inside;                  // the patch counts as the object
};

struct Carving {
  VoxelGrid grid;                  // Equation 3.1: voxels that every view shows as surface or edge
  std::vector<PatchLabels> views;  // in the order of the view set: V^s and V^b are their kSurface and kEdge bits
};

/// Silhouette carving, Algorithms 3.1 and 3.2 of \cite silva_2018: the discrete visual hull \cite laurentini_1994, with
/// the three labels kept per view. Strokes count as the object. \throws std::invalid_argument on an option out of
/// range; NoResult if no voxel is left
Carving carve_silhouettes(const ViewSet& views, const CarveOptions& options = {});

}  // namespace carve
