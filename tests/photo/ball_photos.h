#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "carve/photo/rig.h"

namespace carve {

/// Photos of a ball whose colour is a function of the place, by the quadratic formula: what a renderer must agree with.
struct BallScene {
  Vec3 centre = {0, 0.5, 0};
  double radius = 0.5;
  std::function<Rgba(const Vec3&)> colour = [](const Vec3&) { return Rgba{200, 200, 200, 255}; };

  /// The nearer of the places where a camera's pixel sees the ball.
  std::optional<Vec3> hit(const Camera& camera, const Vec2& pixel) const {
    const Vec3 eye = camera.centre(), d = ray(camera, pixel).normalized(), to = centre - eye;
    const double along = to.dot(d), off = to.squaredNorm() - along * along;
    if (off > radius * radius) return {};
    return eye + (along - std::sqrt(radius * radius - off)) * d;
  }

  std::vector<Photo> photos(const RigOptions& options) const {
    std::vector<Photo> all;
    for (const Camera& camera : rig(centre.array() - radius, centre.array() + radius, options)) {
      Photo photo{camera, Picture(camera.width, camera.height, {0, 0, 0, 255}), Mask(camera.width, camera.height)};
      for (int j = 0; j < camera.height; ++j)
        for (int i = 0; i < camera.width; ++i)
          if (const auto place = hit(camera, {i + 0.5, j + 0.5}))
            photo.picture(i, j) = colour(*place), photo.mask(i, j) = 1;
      all.push_back(std::move(photo));
    }
    return all;
  }
};

/// Smooth stripes along three directions, which tell places apart.
inline Rgba striped(const Vec3& p) {
  const auto wave = [&](double x, double y, double z) {
    return static_cast<std::uint8_t>(std::lround(128 + 110 * std::sin(x * p.x() + y * p.y() + z * p.z())));
  };
  return {wave(23, 11, -7), wave(-9, 27, 13), wave(17, -13, 25), 255};
}

}  // namespace carve
