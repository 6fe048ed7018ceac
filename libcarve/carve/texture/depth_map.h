#pragma once
#include "carve/mesh/mesh.h"
#include "carve/views/view_set.h"

namespace carve {

/// The nearest and the farthest surface behind each pixel of a drawing: true occlusion in the drawing's own frame, at
/// its resolution (rasters above kLargestSide are halved until they are below). A z-buffer in software.
class DepthMap {
 public:
  static constexpr int kLargestSide = 2048;
  DepthMap(const Mesh& mesh, const AlignedView& view);

  struct Range {
    float nearest, farthest;  // coordinate along the view's `toward`; nearest < farthest where there is no surface
  };
  Range at(const Vec3& point) const;  // of the pixel the point projects to
  double depth(const Vec3& point) const { return toward_.sign * point[toward_.axis]; }
  double pixel() const { return pixel_; }  // a pixel's longer side in object units

 private:
  void draw(const Vec3& a, const Vec3& b, const Vec3& c);
  Vec2 place(const Vec3& point) const;

  SignedAxis toward_;
  int right_, up_;  // axes
  double column0_, column_per_unit_, row0_, row_per_unit_, pixel_;
  Raster<Range> ranges_;
};

}  // namespace carve
