#include "carve/photo/plane_sweep.h"

#include <Eigen/Geometry>

#include "carve/core/parallel.h"

namespace carve {
namespace {

// Every pixel's least or largest channels among the object's pixels up to `reach` away along x and along y.
template <class Choose>
Picture around(const Photo& photo, int reach, Rgba none, Choose&& choose) {
  const auto pass = [&](const Picture& from, int dx, int dy) {
    Picture to(from.width, from.height, none);
    parallel_ranges(0, from.height, 16, [&](int first, int last) {
      for (int y = first; y < last; ++y)
        for (int x = 0; x < from.width; ++x) {
          Rgba& p = to(x, y);
          for (int k = -reach; k <= reach; ++k)
            if (from.contains(x + k * dx, y + k * dy)) {
              const Rgba& q = from(x + k * dx, y + k * dy);
              p = {choose(p.r, q.r), choose(p.g, q.g), choose(p.b, q.b), 255};
            }
        }
    });
    return to;
  };
  Picture object = photo.picture;
  for (std::size_t i = 0; i < object.pixels.size(); ++i)
    if (!photo.mask.pixels[i]) object.pixels[i] = none;
  return pass(pass(object, 1, 0), 0, 1);
}

}  // namespace

Eye eye_of(const Photo& photo, const Vec3& middle, double margin) {
  const Camera& camera = photo.camera;
  const double depth = camera.in_camera(middle).z();
  const int reach = depth > 0 ? static_cast<int>(std::lround(std::min(64.0, margin * camera.focal / depth))) : 0;
  const Vec3 base = ray(camera, {0.5, 0.5});
  return {.photo = &photo,
          .centre = camera.centre(),
          .base = base,
          .right = ray(camera, {1.5, 0.5}) - base,
          .down = ray(camera, {0.5, 1.5}) - base,
          .low = around(photo, reach, {255, 255, 255, 255}, [](auto a, auto b) { return std::min(a, b); }),
          .high = around(photo, reach, {0, 0, 0, 255}, [](auto a, auto b) { return std::max(a, b); }),
          .taken = {},
          .hits = {},
          .near = Raster<float>(camera.width, camera.height, INFINITY),
          .owner = Raster<int>(camera.width, camera.height, -1)};
}

double entry(const Vec3& c, double h, const Vec3& direction) {
  double near = 0, far = INFINITY;
  for (int k = 0; k < 3; ++k) {
    const double inverse = 1 / direction[k];
    const double a = (c[k] - h) * inverse, b = (c[k] + h) * inverse;
    near = std::max(near, std::min(a, b)), far = std::min(far, std::max(a, b));
  }
  return near < far ? near : -1;
}

}  // namespace carve
