#include "eval/texture_sheet.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "eval/render.h"

namespace carve {
namespace {

constexpr double kAzimuths[] = {35, 125, 215, 305}, kElevation = 25;

// The middle of every block of texels that falls on a pixel would alias; their mean does not.
Picture shrunk(const Picture& texture, int size) {
  Picture small(size, size);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const auto range = [&](int i, int count) {
        const int first = static_cast<int>(std::int64_t{i} * count / size);
        return std::pair(first, std::max(first + 1, static_cast<int>(std::int64_t{i + 1} * count / size)));
      };
      const auto [x0, x1] = range(x, texture.width);
      const auto [y0, y1] = range(y, texture.height);
      Vec3i sum = Vec3i::Zero();
      for (int v = y0; v < y1; ++v)
        for (int u = x0; u < x1; ++u) sum += Vec3i(texture(u, v).r, texture(u, v).g, texture(u, v).b);
      sum /= (x1 - x0) * (y1 - y0);
      small(x, y) = {static_cast<std::uint8_t>(sum.x()), static_cast<std::uint8_t>(sum.y()),
                     static_cast<std::uint8_t>(sum.z()), 255};
    }
  return small;
}

// Mean of 2 x 2 pixels, what is transparent counting as white.
Picture halved(const Picture& picture) {
  Picture half(picture.width / 2, picture.height / 2);
  for (int y = 0; y < half.height; ++y)
    for (int x = 0; x < half.width; ++x) {
      Vec3i sum(2, 2, 2);  // rounds
      for (const auto& [u, v] : {std::pair(0, 0), {1, 0}, {0, 1}, {1, 1}}) {
        const Rgba p = picture(2 * x + u, 2 * y + v);
        sum += p.a ? Vec3i(p.r, p.g, p.b) : Vec3i(255, 255, 255);
      }
      half(x, y) = {static_cast<std::uint8_t>(sum.x() / 4), static_cast<std::uint8_t>(sum.y() / 4),
                    static_cast<std::uint8_t>(sum.z() / 4), 255};
    }
  return half;
}

// The box of the model in a camera's picture plane.
Eigen::AlignedBox2d seen_box(const Mesh& mesh, const CameraAxes& axes) {
  Eigen::AlignedBox2d box;
  for (const Vec3& p : mesh.positions) box.extend(Vec2(axes.right.dot(p), axes.up.dot(p)));
  return box;
}

}  // namespace

Picture texture_sheet(const TexturedMesh& model, int size) {
  constexpr int kMargin = 4;
  double extent = 0;
  for (const double azimuth : kAzimuths)
    extent = std::max(extent, seen_box(model.mesh, camera(azimuth, kElevation)).sizes().maxCoeff());
  const double pixel = extent / std::max(1, 2 * (size - 2 * kMargin));  // of a picture twice as large
  Picture sheet(5 * size, size);
  const auto put = [&](const Picture& picture, int column) {
    for (int y = 0; y < size; ++y) std::copy_n(&picture(0, y), size, &sheet(column * size, y));
  };
  for (int i = 0; i < 4; ++i) {
    const CameraAxes axes = camera(kAzimuths[i], kElevation);
    const Vec2 centre = seen_box(model.mesh, axes).center();
    const Window window{2 * size, 2 * size, centre.x() - pixel * size, pixel, centre.y() + pixel * size, -pixel};
    put(halved(render(model, axes, window, true)), i);
  }
  put(shrunk(model.texture, size), 4);
  return sheet;
}

}  // namespace carve
