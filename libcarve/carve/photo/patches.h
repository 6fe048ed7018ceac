#pragma once
#include <span>

#include "carve/core/monitor.h"
#include "carve/photo/stereo.h"

namespace carve {

/// Names and defaults as in PMVS2's option file.
struct PatchOptions {
  bool masks = true;
  int level = 1;
  int csize = 2;
  int wsize = 7;
  double threshold = 0.7;
  int min_image_num = 3;
  double angle = 60;  // degrees
  int images = 6;
  int rounds = 3;
};
template <class Visitor>
void visit_fields(PatchOptions& o, Visitor&& field) {
  field("masks", o.masks,
        "windows must lie on the object; off: background is matched too, as far as it lies in the box");
  field("level", o.level, 0, 8, "photos are halved so many times");
  field("csize", o.csize, 1, 64, "side of the cells that get a patch each, in pixels of the halved photos");
  field("wsize", o.wsize, 3, 21, "side of the windows that are compared, in the same pixels, odd");
  field("threshold", o.threshold, 0.0, 1.0, "least normalised cross-correlation of photos that agree");
  field("min_image_num", o.min_image_num, 2, 100, "photos that must agree on a patch");
  field("angle", o.angle, 1.0, 89.0, "largest angle in degrees between a patch's normal and a line of sight to it");
  field("images", o.images, 2, 100, "most photos that a patch is refined on; more may agree with it");
  field("rounds", o.rounds, 1, 20, "rounds of expansion and filtering");
}

/// Multi-view stereo by patches \cite furukawa_2010: small squares of the surface that photos agree on.
///
/// Corners and blobs of one photo are paired along epipolar lines with those of its neighbours (match); each patch
/// spreads to the neighbouring cells of the photos that see it (expand); those that hide others, are hidden, or have
/// few neighbours go (filter). A patch's depth and the two angles of its normal are refined by least squares (Ceres) on
/// windows of mean 0 and length 1, whose squared difference is 2 (1 - NCC). Windows without contrast are no evidence.
///
/// Time and memory are bounded by the number of cells: every patch fills an empty one, and none is tried more often
/// than twice a round. The result lies in the box; it does not depend on the number of threads.
/// \throws std::invalid_argument on an option out of range, an even wsize, photos too small for level and wsize, or
/// pictures not of their camera's size
OrientedPoints patches(std::span<const Photo> photos, const Vec3& low, const Vec3& high,
                       const PatchOptions& options = {}, const Monitor& monitor = {});

/// A point of the surface, and which photos show it.
struct SeenPoint {
  Vec3 position = Vec3::Zero();
  std::vector<int> photos = {};
};

/// What patches() starts from: features of neighbouring photos on one epipolar line, where min_image_num photos agree.
/// Such sparse points structure from motion has, and view selection \cite furukawa_2010_cmvs wants. \throws as patches
std::vector<SeenPoint> matched_features(std::span<const Photo> photos, const Vec3& low, const Vec3& high,
                                        const PatchOptions& options = {});

}  // namespace carve
