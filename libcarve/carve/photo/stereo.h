#pragma once
#include <span>
#include <vector>

#include "carve/core/monitor.h"
#include "carve/photo/camera.h"

namespace carve {

/// Points of a surface with unit normals that point out of the object.
struct OrientedPoints {
  std::vector<Vec3> positions, normals;
};

struct StereoOptions {
  bool masks = true;
  double angle = 45;  // degrees
  int window = 5;     // pixels
  int contrast = 8;   // of 255
  double agreement = 1;
  int support = 2;
  double spacing = 0.5;
};
template <class Visitor>
void visit_fields(StereoOptions& o, Visitor&& field) {
  field("masks", o.masks,
        "only the object's pixels are matched; off: the background too, as far as it lies in the box");
  field("angle", o.angle, 0.1, 89.0, "largest angle in degrees between the two photos of a pair");
  field("window", o.window, 1, 21, "side of the windows that are compared, in pixels, odd");
  field("contrast", o.contrast, 0, 255, "windows whose brightness varies by less are not matched, of 255");
  field("agreement", o.agreement, 0.001, 100.0, "depths that differ by less agree, % of the box's diagonal");
  field("support", o.support, 0, 100, "other pairs that must agree with a point's depth");
  field("spacing", o.spacing, 0.01, 100.0, "points nearer than that become one, % of the box's diagonal");
}

/// What one pair of photos sees: depths along z of the rectified left camera, 0 where nothing was found.
struct DepthMap {
  Camera camera;
  Raster<float> depth;
};

/// Dense stereo with known poses: every photo is paired with the one whose viewing direction is next to its own on its
/// right, if that is within `angle`; pairs are rectified and matched by semi-global block matching
/// \cite hirschmueller_2008 (OpenCV's StereoSGBM, left-right check, sub-pixel). Depths are searched within the box.
/// \throws std::invalid_argument on an option out of range, an even window, or pictures not of their camera's size
std::vector<DepthMap> depth_maps(std::span<const Photo> photos, const Vec3& low, const Vec3& high,
                                 const StereoOptions& options = {}, const Monitor& monitor = {});

/// The depth maps' points that `support` other maps agree with and that lie in the box, averaged over cubes of
/// `spacing`; normals by fitting planes to neighbours, turned to the cameras that saw the point.
OrientedPoints fuse(std::span<const DepthMap> maps, const Vec3& low, const Vec3& high,
                    const StereoOptions& options = {}, const Monitor& monitor = {});

/// Normals of planes through the nearest points, turned to the side that `towards` points to. Empty if there are fewer
/// points than a plane is fitted to.
OrientedPoints with_normals(const std::vector<Vec3>& positions, const std::vector<Vec3>& towards);

}  // namespace carve
