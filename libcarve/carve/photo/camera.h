#pragma once
#include <Eigen/Core>
#include <span>

#include "carve/core/raster.h"
#include "carve/core/vector.h"

namespace carve {

/// A pinhole camera without distortion \cite hartley_2004.
///
/// Camera axes are x right, y down, z forward: a world point X lies at Y = rotation * X + translation there, and in the
/// picture at focal * (Y.x, Y.y) / Y.z + principal, in pixels from the picture's upper left corner. Pixel (i, j) covers
/// [i, i + 1) x [j, j + 1), so its centre is at (i + 0.5, j + 0.5).
struct Camera {
  int width = 0, height = 0;  // pixels
  double focal = 1;           // pixels, along both axes
  Vec2 principal = Vec2::Zero();
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Vec3 translation = Vec3::Zero();

  Vec3 in_camera(const Vec3& world) const { return rotation * world + translation; }
  Vec3 centre() const { return -(rotation.transpose() * translation); }
  bool operator==(const Camera&) const = default;
};

/// What takes camera axes to the picture, up to scale.
Eigen::Matrix3d intrinsics(const Camera& camera);

/// The 3x4 projection matrix P: the picture of world point X is P (X, 1), up to scale.
Eigen::Matrix<double, 3, 4> projection(const Camera& camera);

/// Where a world point is seen. Only for points before the camera (in_camera(x).z() > 0).
Vec2 project(const Camera& camera, const Vec3& world);

/// From the camera's centre through a place in the picture, in world axes, one unit long along the camera's z: the
/// point at depth z is centre + z * ray.
Vec3 ray(const Camera& camera, const Vec2& pixel);

/// A camera at `eye` whose picture's middle shows `target`, `up` pointing up in the picture. The field of view in
/// degrees is that of the picture's width. \throws std::invalid_argument if eye and target coincide, up is parallel to
/// the line between them, a side is not in [1, 16384] or the field of view not in (0, 180)
Camera look_at(const Vec3& eye, const Vec3& target, const Vec3& up, int width, int height, double field_of_view);

/// A picture with its camera and what of it shows the object.
struct Photo {
  Camera camera;
  Picture picture;
  Mask mask;  // 1 = the object covers at least half of the pixel
};

/// \throws std::invalid_argument naming the photo whose picture or mask is not as large as its camera says
void check_photos(std::span<const Photo> photos);

}  // namespace carve
