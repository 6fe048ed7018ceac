#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "carve/photo/patches.h"

namespace carve {

/// A small square of the surface.
struct Patch {
  Vec3 centre = Vec3::Zero(), normal = Vec3::Zero();
  std::vector<int> views = {};  // that agree on it; the first is the one it was refined against
  double score = 0;             // mean NCC of the others with the first
};

/// A photo at the level that patches are matched at.
struct PatchView {
  Camera camera;
  Raster<Eigen::Vector3f> colours;
  Mask usable;                  // where windows may lie
  std::vector<int> neighbours;  // other views that a patch may face besides, the nearest first
};

/// Tells how well photos agree on a patch, and makes them agree better.
class Photometry {
 public:
  Photometry(std::span<const Photo> photos, const Vec3& low, const Vec3& high, const PatchOptions& options);

  const std::vector<PatchView>& views() const { return views_; }
  const PatchOptions& options() const { return options_; }

  bool in_box(const Vec3& p) const { return (p.array() >= low_.array()).all() && (p.array() <= high_.array()).all(); }
  /// Side of a cell where a point is, in world units.
  double cell_size(int view, const Vec3& point) const;
  /// NCC of two views' windows around a patch, those of `reference` being pixels; -1 where either has none.
  double agreement(const Patch& patch, int reference, int view) const;
  /// The patch refined against views()[reference] and judged: nothing if too few photos agree on it.
  std::optional<Patch> refined(Patch patch, int reference) const;

 private:
  std::vector<int> agreeing(const Patch& patch, int reference, double threshold, double& score) const;

  PatchOptions options_;
  Vec3 low_, high_;
  double least_cosine_;
  std::vector<PatchView> views_;
};

/// First patches: pairs of features of neighbouring photos on one epipolar line. Only those that photos agree on.
std::vector<Patch> match_features(const Photometry& photometry);

}  // namespace carve
