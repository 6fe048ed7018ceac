#include "eval/texture_sheet.h"

#include <Eigen/Geometry>

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

}  // namespace

Picture texture_sheet(const TexturedMesh& model, int size) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : model.mesh.positions) box.extend(p);
  const Vec3 centre = box.center();
  const double pixel = box.diagonal().norm() / size;
  Picture sheet(5 * size, size, {255, 255, 255, 255});
  const auto put = [&](const Picture& picture, int column) {
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
        if (picture(x, y).a) sheet(column * size + x, y) = picture(x, y);
  };
  for (int i = 0; i < 4; ++i) {
    const CameraAxes axes = camera(kAzimuths[i], kElevation);
    const Window window{
        size, size, axes.right.dot(centre) - pixel * size / 2, pixel, axes.up.dot(centre) + pixel * size / 2, -pixel};
    put(render(model, axes, window, true), i);
  }
  put(shrunk(model.texture, size), 4);
  return sheet;
}

}  // namespace carve
