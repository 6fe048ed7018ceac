#pragma once
#include <functional>

#include "carve/carving/carve_silhouettes.h"
#include "carve/surface/marching_cubes.h"
#include "carve/surface/smooth.h"
#include "carve/texture/texture.h"
#include "shapes.h"

namespace carve {

/// A colour per view and pixel; only what is not background is painted.
using Painter = std::function<Rgba(View view, int x, int y)>;

inline std::map<View, Drawing> painted(std::map<View, Drawing> drawings, const Painter& painter) {
  for (auto& [view, drawing] : drawings)
    for (int y = 0; y < drawing.picture.height; ++y)
      for (int x = 0; x < drawing.picture.width; ++x)
        if (drawing.labels(x, y) == Label::surface) drawing.picture(x, y) = painter(view, x, y);
  return drawings;
}

inline Rgba plain(View view, int, int) {
  static constexpr Rgba kColours[] = {{200, 40, 40, 255},  {40, 180, 60, 255},  {50, 70, 210, 255},
                                      {220, 200, 40, 255}, {160, 60, 190, 255}, {60, 190, 200, 255}};
  return kColours[static_cast<int>(view)];
}

/// No two neighbouring pixels alike.
inline Rgba noise(View view, int x, int y) {
  const unsigned h = (static_cast<unsigned>(x) * 73856093U) ^ (static_cast<unsigned>(y) * 19349663U) ^
                     (static_cast<unsigned>(view) * 83492791U);
  return {static_cast<std::uint8_t>(80 + h % 160), static_cast<std::uint8_t>(80 + h / 160 % 160),
          static_cast<std::uint8_t>(80 + h / 25600 % 160), 255};
}

struct Scene {
  ViewSet views;
  Mesh mesh;
};

inline Mesh mesh_of(const ViewSet& views, int grid, int steps = 2) {
  return smooth(marching_cubes(carve_silhouettes(views, {.grid = grid}).grid, {}), {.steps = steps});
}

inline Scene scene(const Shape& shape, const Painter& painter, const DrawOptions& options = {}, int grid = 32) {
  Scene scene{align(painted(draw(shape, kThreeViews, options), painter)), {}};
  scene.mesh = mesh_of(scene.views, grid);
  return scene;
}

inline TexturedMesh textured(const Scene& scene, TextureOptions options = {},
                             const AtlasOptions& atlas = {.size = 512}) {
  if (options.arm == TextureArm::automatic) options.arm = TextureArm::best_view;
  return texture(scene.mesh, scene.views, options, atlas);
}

/// Per texel, the triangle its centre lies well inside of; -1 none, -2 several. Triangles laid out face down count too.
inline Raster<int> covering(const TexturedMesh& model) {
  const int size = model.texture.width;
  Raster<int> cover(size, size, -1);
  for (int t = 0; t < static_cast<int>(model.uv_triangles.size()); ++t) {
    Vec2 p[3];
    for (int k = 0; k < 3; ++k) p[k] = model.uvs[model.uv_triangles[t][k]] * size;
    const auto cross = [](const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); };
    const double area = cross(p[1] - p[0], p[2] - p[0]);
    const Vec2 low = p[0].cwiseMin(p[1]).cwiseMin(p[2]), high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
    for (int y = std::max(0, static_cast<int>(low.y())); y <= std::min<double>(high.y(), size - 1); ++y)
      for (int x = std::max(0, static_cast<int>(low.x())); x <= std::min<double>(high.x(), size - 1); ++x) {
        const Vec2 c(x + 0.5, y + 0.5);
        bool inside = area != 0;
        for (int k = 0; k < 3; ++k) inside &= cross(p[(k + 1) % 3] - p[k], c - p[k]) / area > 1e-5;
        if (inside) cover(x, y) = cover(x, y) == -1 ? t : -2;
      }
  }
  return cover;
}

/// Per triangle, which set of triangles that share texture coordinates it belongs to.
std::vector<int> charts_of(const TexturedMesh& model);

}  // namespace carve
