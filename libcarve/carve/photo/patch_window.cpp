#include "carve/photo/patch_window.h"

#include <Eigen/Geometry>
#include <cmath>

namespace carve {
namespace {

// Deviation per sample, of 255. What varies less may be rounding.
constexpr double kLeastContrast = 1.5;

// A channel's values between four pixels, and how they change.
struct Bilinear {
  std::size_t at;
  int width;
  float x, y;

  Eigen::Vector3f value(const Raster<Eigen::Vector3f>& c) const {
    return (1 - y) * ((1 - x) * c.pixels[at] + x * c.pixels[at + 1]) +
           y * ((1 - x) * c.pixels[at + width] + x * c.pixels[at + width + 1]);
  }
  Eigen::Vector3f along_x(const Raster<Eigen::Vector3f>& c) const {
    return (1 - y) * (c.pixels[at + 1] - c.pixels[at]) + y * (c.pixels[at + width + 1] - c.pixels[at + width]);
  }
  Eigen::Vector3f along_y(const Raster<Eigen::Vector3f>& c) const {
    return (1 - x) * (c.pixels[at + width] - c.pixels[at]) + x * (c.pixels[at + width + 1] - c.pixels[at + 1]);
  }
};

// Mean 0 of each channel, length 1 of all; slopes follow.
bool normalise(Window& w, WindowSlopes* slopes, int samples) {
  for (int k = 0; k < 3; ++k) {
    auto channel = w.segment(k * samples, samples);
    channel.array() -= channel.mean();
    if (!slopes) continue;
    for (int j = 0; j < 3; ++j) {
      auto slope = slopes->col(j).segment(k * samples, samples);
      slope.array() -= slope.mean();
    }
  }
  const double length = w.norm();
  if (length < kLeastContrast * std::sqrt(3.0 * samples)) return false;
  w /= length;
  if (slopes)
    for (int j = 0; j < 3; ++j) slopes->col(j) = (slopes->col(j) - w * w.dot(slopes->col(j))) / length;
  return true;
}

}  // namespace

PlaneView plane_view(const Camera& reference, const Vec3& centre, const Vec3& normal) {
  const Vec2 at = project(reference, centre);
  const Vec3 from = ray(reference, at);
  const Vec3 right = reference.rotation.row(0) / reference.focal, down = reference.rotation.row(1) / reference.focal;
  const double off = normal.dot(centre - reference.centre());
  return {&reference, from, right, down, Vec3(normal.dot(from), normal.dot(right), normal.dot(down)) / off};
}

bool window(const PatchView& view, const PlaneView& plane, int wsize, Window& out, WindowSlopes* slopes) {
  const int half = wsize / 2, samples = wsize * wsize;
  out.resize(3 * samples);
  if (slopes) slopes->resize(3 * samples, 3);
  const Camera& camera = view.camera;
  const Vec3 eye = camera.in_camera(plane.reference->centre());
  const Vec3 from = camera.rotation * plane.from, right = camera.rotation * plane.right,
             down = camera.rotation * plane.down;
  int at = 0;
  for (int y = -half; y <= half; ++y)
    for (int x = -half; x <= half; ++x, ++at) {
      const double w = plane.w.x() + x * plane.w.y() + y * plane.w.z();
      const Vec3 p = w * eye + from + x * right + y * down;  // the point times w
      if (w <= 0 || p.z() <= 0) return false;
      const double u = camera.focal * p.x() / p.z() + camera.principal.x() - 0.5,
                   v = camera.focal * p.y() / p.z() + camera.principal.y() - 0.5;
      if (!(u >= 0 && v >= 0 && u < camera.width - 1 && v < camera.height - 1)) return false;
      const int i = static_cast<int>(u), j = static_cast<int>(v);
      if (!view.usable(static_cast<int>(u + 0.5), static_cast<int>(v + 0.5))) return false;
      const Bilinear b{static_cast<std::size_t>(j) * camera.width + i, camera.width, static_cast<float>(u - i),
                       static_cast<float>(v - j)};
      const Eigen::Vector3f colour = b.value(view.colours);
      for (int k = 0; k < 3; ++k) out[k * samples + at] = colour[k];
      if (!slopes) continue;
      const double scale = camera.focal / (p.z() * p.z());
      const double du = scale * (eye.x() * p.z() - eye.z() * p.x()), dv = scale * (eye.y() * p.z() - eye.z() * p.y());
      const Vec3 slope = du * b.along_x(view.colours).cast<double>() + dv * b.along_y(view.colours).cast<double>();
      for (int k = 0; k < 3; ++k) slopes->row(k * samples + at) = slope[k] * Eigen::RowVector3d(1, x, y);
    }
  return normalise(out, slopes, samples);
}

}  // namespace carve
