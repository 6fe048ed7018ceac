#include "eval/shade.h"

#include <Eigen/Geometry>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "carve/core/parallel.h"

namespace carve {
namespace {

constexpr int kSupersampling = 3;

Vec3 face_normal(const Mesh& mesh, int t) {
  const auto [a, b, c] = mesh.triangles[t];
  const Vec3 n = (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]);
  return n.norm() > 0 ? Vec3(n.normalized()) : Vec3(Vec3::Zero());
}

}  // namespace

CameraAxes named_camera(const std::string& text) {
  for (const View view : kViews)
    if (text == name(view)) return camera(view);
  if (text == "three_quarter") return camera(35, 22);
  const auto colon = text.find(':');
  double azimuth = 0, elevation = 0;
  const auto number = [](std::string_view part, double& value) {
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    return error == std::errc() && end == part.data() + part.size();
  };
  if (colon == std::string::npos || !number(std::string_view(text).substr(0, colon), azimuth) ||
      !number(std::string_view(text).substr(colon + 1), elevation) || std::abs(azimuth) > 360 ||
      std::abs(elevation) > 90)
    throw std::invalid_argument("views must be " +
                                std::string("front, side, top, back, left, bottom, three_quarter or ") +
                                "AZIMUTH:ELEVATION, got " + text);
  return camera(azimuth, elevation);
}

Window window_around(const CameraAxes& axes, const std::vector<Vec3>& points, double pixels_per_unit) {
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Vec3& point : points) {
    const Vec2 seen(point.dot(axes.right), point.dot(axes.up));
    low = low.cwiseMin(seen);
    high = high.cwiseMax(seen);
  }
  const double step = 1 / pixels_per_unit;
  const auto pixels = [&](int k) { return std::max(1, static_cast<int>(std::ceil((high[k] - low[k]) / step))); };
  const int width = pixels(0), height = pixels(1);
  const Vec2 middle = (low + high) / 2;
  return {width, height, middle.x() - width * step / 2, step, middle.y() + height * step / 2, -step};
}

Picture shade(const Mesh& mesh, const CameraAxes& axes, const Window& window, const Paint& paint) {
  Window fine = window;
  fine.width *= kSupersampling, fine.height *= kSupersampling;
  fine.right_per_pixel /= kSupersampling, fine.up_per_pixel /= kSupersampling;
  const Seen seen = rasterise(mesh, axes, fine);
  const Vec3 light = (axes.toward + 0.5 * axes.up - 0.4 * axes.right).normalized();
  const auto shaded = [&](int x, int y) -> Vec3 {
    const int t = seen.triangle(x, y);
    if (t < 0) return Vec3::Constant(255);
    const double right = fine.right0 + (x + 0.5) * fine.right_per_pixel, up = fine.up0 + (y + 0.5) * fine.up_per_pixel;
    const Rgba own = paint(t, right, up);
    const Vec3 normal = face_normal(mesh, t);
    const double facing = normal.dot(axes.toward) < 0 ? -normal.dot(light) : normal.dot(light);
    return Vec3(own.r, own.g, own.b) * (0.6 + 0.4 * std::max(0.0, facing));
  };
  Picture picture(window.width, window.height, Rgba{255, 255, 255, 255});
  parallel_ranges(0, window.height, 8, [&](int first, int last) {
    for (int y = first; y < last; ++y)
      for (int x = 0; x < window.width; ++x) {
        Vec3 sum = Vec3::Zero();
        for (int j = 0; j < kSupersampling; ++j)
          for (int i = 0; i < kSupersampling; ++i) sum += shaded(x * kSupersampling + i, y * kSupersampling + j);
        sum /= kSupersampling * kSupersampling;
        const auto channel = [](double value) { return static_cast<std::uint8_t>(std::lround(value)); };
        picture(x, y) = {channel(sum.x()), channel(sum.y()), channel(sum.z()), 255};
      }
  });
  return picture;
}

void paste(Picture& onto, const Picture& picture, int x0, int y0) {
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      if (onto.contains(x0 + x, y0 + y)) onto(x0 + x, y0 + y) = picture(x, y);
}

}  // namespace carve
