#pragma once
#include <span>

#include "carve/core/monitor.h"
#include "carve/grid/voxel_grid.h"
#include "carve/photo/camera.h"

namespace carve {

struct SpaceCarvingOptions {
  double threshold = 10;  // of 255
  double margin = 0.5;    // voxels
  double visible = 0.5;
  double outliers = 0.1;
  int rounds = 50;
};
template <class Visitor>
void visit_fields(SpaceCarvingOptions& o, Visitor&& field) {
  field("threshold", o.threshold, 0.0, 255.0, "how far apart colours may be that still are one colour, of 255");
  field("margin", o.margin, 0.0, 10.0,
        "how far in voxels the surface may lie off a voxel that stands for it: colours so near count as the voxel's");
  field("visible", o.visible, 0.0, 1.0, "share of a voxel's pixels that must not be hidden for a photo to have a say");
  field("outliers", o.outliers, 0.0, 0.49, "share of the photos that may disagree");
  field("rounds", o.rounds, 1, 10000, "most rounds of six sweeps; it ends when a round carves nothing");
}

/// What Space Carving did.
struct SpaceCarving {
  VoxelGrid grid;
  int rounds = 0;           // of six sweeps, the last one that carved nothing included
  bool converged = false;   // the rounds were enough: `grid` is the photo hull of these tests
  std::int64_t carved = 0;  // voxels
};

/// Space Carving by multiple plane sweeps \cite kutulakos_2000: carves from `start` the voxels whose colours differ
/// between the photos that see them, until none is left that does.
///
/// A sweep goes through the grid slice by slice along one axis and asks the photos that lie behind the slice, by the
/// rays that run mainly along that axis; a pixel belongs to the first consistent voxel whose cube its ray enters, later
/// ones are hidden from it. After six sweeps each voxel is tested once more against all photos that saw it in any of
/// them.
///
/// A photo sees a range of colours in each channel: those of the voxel's pixels that are not hidden. A voxel is
/// consistent if the ranges of all photos but `outliers`, widened by `threshold`, meet in every channel (a histogram
/// test \cite slabaugh_2004 with one bin that moves); or if fewer than two photos see it. Pixels out of the mask see
/// nothing: start from silhouette_hull. Light that moves with the camera, or a texture finer than what `threshold` and
/// `margin` allow for within a voxel, carves everything: nothing stops a hole from growing.
///
/// \throws std::invalid_argument on an option out of range, or a picture or mask not as large as its camera's picture
SpaceCarving space_carving(std::span<const Photo> photos, VoxelGrid start, const SpaceCarvingOptions& options = {},
                           const Monitor& monitor = {});

/// The same, but only voxels of `open` may go; the others hide what lies behind them, whatever their colours.
/// \throws also std::invalid_argument if the grids' sizes differ
SpaceCarving space_carving_within(std::span<const Photo> photos, VoxelGrid start, const VoxelGrid& open,
                                  const SpaceCarvingOptions& options = {}, const Monitor& monitor = {});

}  // namespace carve
