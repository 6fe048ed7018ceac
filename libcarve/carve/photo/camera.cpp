#include "carve/photo/camera.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace carve {

Eigen::Matrix3d intrinsics(const Camera& camera) {
  Eigen::Matrix3d k;
  k << camera.focal, 0, camera.principal.x(), 0, camera.focal, camera.principal.y(), 0, 0, 1;
  return k;
}

Eigen::Matrix<double, 3, 4> projection(const Camera& camera) {
  Eigen::Matrix<double, 3, 4> pose;
  pose << camera.rotation, camera.translation;
  return intrinsics(camera) * pose;
}

Vec2 project(const Camera& camera, const Vec3& world) {
  const Vec3 p = camera.in_camera(world);
  return camera.focal / p.z() * p.head<2>() + camera.principal;
}

Vec3 ray(const Camera& camera, const Vec2& pixel) {
  const Vec2 p = (pixel - camera.principal) / camera.focal;
  return camera.rotation.transpose() * Vec3(p.x(), p.y(), 1);
}

Camera look_at(const Vec3& eye, const Vec3& target, const Vec3& up, int width, int height, double field_of_view) {
  if (width < 1 || height < 1 || width > 16384 || height > 16384)
    throw std::invalid_argument("a camera's picture must have sides in [1, 16384], got " + std::to_string(width) +
                                " x " + std::to_string(height));
  if (!(field_of_view > 0 && field_of_view < 180))
    throw std::invalid_argument("field of view must be in (0, 180), got " + std::to_string(field_of_view));
  const Vec3 forward = target - eye, right = forward.cross(up);
  if (!(right.norm() > 1e-9 * forward.norm() * up.norm()))
    throw std::invalid_argument("a camera needs a target away from it, and an up that is not the line of sight");
  Camera camera{.width = width, .height = height};
  camera.focal = width / 2.0 / std::tan(field_of_view / 360 * std::numbers::pi);
  camera.principal = {width / 2.0, height / 2.0};
  camera.rotation.row(0) = right.normalized();
  camera.rotation.row(2) = forward.normalized();
  camera.rotation.row(1) = forward.cross(right).normalized();
  camera.translation = -(camera.rotation * eye);
  return camera;
}

void check_photos(std::span<const Photo> photos) {
  for (std::size_t i = 0; i < photos.size(); ++i) {
    const Photo& photo = photos[i];
    const auto fits = [&](const auto& raster) {
      return raster.width == photo.camera.width && raster.height == photo.camera.height;
    };
    if (!fits(photo.picture) || !fits(photo.mask))
      throw std::invalid_argument("photo " + std::to_string(i) +
                                  ": picture and mask must be as large as the camera's " +
                                  std::to_string(photo.camera.width) + " x " + std::to_string(photo.camera.height));
  }
}

}  // namespace carve
