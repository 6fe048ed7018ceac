#pragma once
#include <cstdint>
#include <span>

#include "carve/core/raster.h"
#include "carve/grid/voxel_grid.h"
#include "carve/views/view_set.h"

namespace carve {

/// When the patch of pixels that a voxel covers in a drawing counts as the object.
enum class Patch {
  centre,  // the voxel's centre lies in the drawn outline (image/outline.h): the sampled visual hull, unbiased
  any      // that, or any of its pixels does, as Algorithm 3.2 has it: keeps thin parts, inflates by up to half a voxel
};
inline std::span<const char* const> names(Patch) {
  static constexpr const char* all[] = {"centre", "any"};
  return all;
}

/// What a voxel's patch shows (Algorithm 3.2), or-ed together.
enum PatchLabel : std::uint8_t { kBackground = 1, kSurface = 2, kEdge = 4 };

/// One drawing at the grid's resolution, laid out as in grid/shadow.h.
struct PatchLabels {
  View view = View::front;
  Raster<std::uint8_t> labels;  // PatchLabel bits of all pixels in the patch
  Mask inside;                  // the patch counts as the object
};

/// Projects the grid's voxels into a drawing, Algorithm 3.2 of \cite silva_2018. A pixel belongs to the patch its
/// centre lies in (to both where it lies between two); a patch that holds no pixel's centre takes the pixel it lies in.
/// What counts as the object has kSurface or kEdge. Outside the drawing is background. Of `grid` only size, place and
/// spacing count.
PatchLabels patch_labels(const AlignedView& view, const VoxelGrid& grid, Patch patch = Patch::centre);

}  // namespace carve
