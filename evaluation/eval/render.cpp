#include "eval/render.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "carve/core/parallel.h"
#include "carve/mesh/neighbours.h"

namespace carve {

Colour texture_at(const Picture& texture, const Vec2& uv) {
  const double x = std::clamp(uv.x() * texture.width - 0.5, 0.0, texture.width - 1.0);
  const double y = std::clamp(uv.y() * texture.height - 0.5, 0.0, texture.height - 1.0);
  const int i = static_cast<int>(x), j = static_cast<int>(y);
  const int right = std::min(i + 1, texture.width - 1), down = std::min(j + 1, texture.height - 1);
  const auto s = static_cast<float>(x - i), t = static_cast<float>(y - j);
  const auto colour = [&](int u, int v) {
    const Rgba p = texture(u, v);
    return Colour(p.r, p.g, p.b);
  };
  return (1 - t) * ((1 - s) * colour(i, j) + s * colour(right, j)) +
         t * ((1 - s) * colour(i, down) + s * colour(right, down));
}

Raster<Vec2> seen_uvs(const TexturedMesh& model, const CameraAxes& axes, const Window& window, const Seen& seen) {
  Raster<Vec2> uvs(window.width, window.height, Vec2::Constant(std::nan("")));
  parallel_ranges(0, window.height, 16, [&](int first, int last) {
    for (int y = first; y < last; ++y)
      for (int x = 0; x < window.width; ++x) {
        const int t = seen.triangle(x, y);
        if (t < 0) continue;
        const Vec2 here(window.right0 + (x + 0.5) * window.right_per_pixel,
                        window.up0 + (y + 0.5) * window.up_per_pixel);
        Vec2 corner[3];
        for (int k = 0; k < 3; ++k) {
          const Vec3& p = model.mesh.positions[model.mesh.triangles[t][k]];
          corner[k] = Vec2(p.dot(axes.right), p.dot(axes.up));
        }
        Eigen::Matrix2d edges;
        edges << corner[1] - corner[0], corner[2] - corner[0];
        const Vec2 weight = edges.inverse() * (here - corner[0]);
        const auto& [a, b, c] = model.uv_triangles[t];
        uvs(x, y) =
            model.uvs[a] + weight.x() * (model.uvs[b] - model.uvs[a]) + weight.y() * (model.uvs[c] - model.uvs[a]);
      }
  });
  return uvs;
}

Rgba to_pixel(const Colour& colour) {
  const auto byte = [](float value) { return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 255.0F))); };
  return {byte(colour[0]), byte(colour[1]), byte(colour[2]), 255};
}

Picture render(const TexturedMesh& model, const CameraAxes& axes, const Window& window, bool shaded) {
  const Seen seen = rasterise(model.mesh, axes, window);
  const Raster<Vec2> uvs = seen_uvs(model, axes, window, seen);
  const std::vector<Vec3> normals = shaded ? triangle_normals(model.mesh) : std::vector<Vec3>();
  const Vec3 light = (axes.toward + 0.5 * axes.up - 0.4 * axes.right).normalized();
  Picture picture(window.width, window.height, {255, 255, 255, 0});
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    const int t = seen.triangle.pixels[i];
    if (t < 0) continue;
    Colour colour = texture_at(model.texture, uvs.pixels[i]);
    if (shaded) colour *= static_cast<float>(0.65 + 0.35 * std::abs(normals[t].dot(light)));
    picture.pixels[i] = to_pixel(colour);
  }
  return picture;
}

}  // namespace carve
