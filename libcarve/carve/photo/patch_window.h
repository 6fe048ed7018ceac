#pragma once
#include "carve/photo/patch_photometry.h"

namespace carve {

/// Three channels of a window one after the other, mean 0 each, of length 1 together.
using Window = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3 * 21 * 21, 1>;
using WindowSlopes = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 3 * 21 * 21, 3>;

/// A plane as a reference view sees it: the inverse of the depth at offset (x, y) from a pixel is w . (1, x, y).
struct PlaneView {
  const Camera* reference;
  Vec3 from, right, down;  // rays: of the pixel, and what one pixel to the right and down adds
  Vec3 w;
};

PlaneView plane_view(const Camera& reference, const Vec3& centre, const Vec3& normal);

/// What `view` shows of the plane under the reference's wsize x wsize pixels around the patch's centre; `slopes`, if
/// asked for, are its derivatives by w. False where a part of it is not usable or it has no contrast.
bool window(const PatchView& view, const PlaneView& plane, int wsize, Window& out, WindowSlopes* slopes = nullptr);

}  // namespace carve
