#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "carve/carving/convex_refinement.h"
#include "carve/carving/part_contours.h"
#include "carve/carving/sections.h"

namespace carve {

/// How far out in its sections' contours a voxel lies: below 1 inside, above 1 outside, 0 where none is rounded.
class ContourField {
 public:
  ContourField(const VoxelGrid& solid, const ViewSet& views, const ConvexOptions& options);
  bool rounds() const { return rounds_[0] || rounds_[1] || rounds_[2]; }
  bool looks_grown() const { return soften_ > 0; }
  /// How far around a ray what it keeps is to be kept too, in voxels.
  int soften() const { return soften_; }
  /// The values of layer z: field[y * nx + x].
  void layer(int z, std::vector<float>& field) const;

 private:
  template <class Use>
  void each_value(int axis, int slice, int v, Use&& use) const;
  void keep_unfilled(int axis, double filled, double convex);
  int voxels(double share) const;
  void weigh_corners(int axis, const std::vector<std::uint8_t>& corners, int reach);
  void row(int axis, int slice, int v, float* field, int step) const;

  Vec3i size_;
  std::array<Sections, 3> cuts_;
  std::array<std::vector<int>, 3> exponents_;                 // of each section
  std::array<std::vector<std::array<float, 4>>, 3> weights_;  // of each section's corners, 1 = rounded
  std::array<bool, 3> rounds_{};
  int soften_ = 0;
};

}  // namespace carve
