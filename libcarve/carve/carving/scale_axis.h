#pragma once
#include <vector>

#include "carve/grid/voxel_grid.h"

namespace carve {

/// How far a voxel lies out of the balls that make up a solid once its blunt edges are rounded: the scale axis
/// transform \cite giesen_2009. Of all balls that lie in the solid, those stay that no other covers when all are
/// `scale` times as large; the solid is the union of what stays. An edge vanishes that is wider than an angle whose
/// half has the sine 1 / scale (2: 60 degrees), with the balls along it; tapers and thin parts stay. What stands on the
/// ground (y = 0 of the grid) counts as going on below it, as a bust does: its rim there is no edge.
///
/// Found on a grid of its own, some 64 cells along the longest side (less than 96), so that it costs the same whatever
/// the solid's: the balls' radii by an exact distance transform, which of them are covered by a chamfer one
/// \cite borgefors_1996.
class ScaleAxis {
 public:
  /// \param scale  1 or more; at 1 all balls stay
  ScaleAxis(const VoxelGrid& solid, double scale);
  /// The values of layer z, field[y * nx + x]: below 1 inside of a ball, above 1 outside of all; squared distances by
  /// the largest ball's radius. 0 if there is no ball.
  void layer(int z, std::vector<float>& field) const;

 private:
  /// Where a voxel's centre lies between two cells.
  struct Between {
    int cell;
    float share;  // of the cell after it
  };
  Vec3i size_;
  std::vector<Between> x_, y_, z_;
  Vec3i cells_;
  std::vector<float> value_;  // per cell, x fastest; empty: there is no ball
};

}  // namespace carve
