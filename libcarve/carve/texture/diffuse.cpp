#include "carve/texture/diffuse.h"

#include <algorithm>
#include <cmath>

#include "carve/core/parallel.h"

namespace carve {
namespace {

// A triangle's corners as linear functions of the texel.
struct OnTriangle {
  double u0 = 0, u_x = 0, u_y = 0, v0 = 0, v_x = 0, v_y = 0;  // weights of the second and third corner
  Vec3 origin = Vec3::Zero(), to_b = Vec3::Zero(), to_c = Vec3::Zero();

  OnTriangle() = default;
  OnTriangle(const Mesh& mesh, const Charts& charts, int t) {
    const auto& [i, j, k] = charts.triangles[t];
    const Vec2 &p = charts.uvs[i], q = charts.uvs[j] - p, r = charts.uvs[k] - p;
    const double area = q.x() * r.y() - q.y() * r.x();
    u_x = r.y() / area, u_y = -r.x() / area, v_x = -q.y() / area, v_y = q.x() / area;
    u0 = -(u_x * p.x() + u_y * p.y()), v0 = -(v_x * p.x() + v_y * p.y());
    const auto& [a, b, c] = mesh.triangles[t];
    origin = mesh.positions[a], to_b = mesh.positions[b] - origin, to_c = mesh.positions[c] - origin;
  }
  double u(double x, double y) const { return u0 + u_x * x + u_y * y; }
  double v(double x, double y) const { return v0 + v_x * x + v_y * y; }
  Vec3 point(double u, double v) const { return origin + u * to_b + v * to_c; }
  Vec3 across() const { return u_x * to_b + v_x * to_c; }
  Vec3 down() const { return u_y * to_b + v_y * to_c; }
};

std::uint8_t to_byte(float value) { return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 255.0F))); }

class Baker {
 public:
  Baker(const Mesh& mesh, const Atlas& atlas, const std::vector<Paint>& paints, const Drawings& drawings,
        const CornerColours& corners)
      : mesh_(mesh), atlas_(atlas), paints_(paints), drawings_(drawings), corners_(corners) {}

  Picture bake() const {
    Picture picture(atlas_.size, atlas_.size);
    parallel_ranges(0, atlas_.size, 16, [&](int first, int last) {
      for (int y = first; y < last; ++y) bake_row(y, picture);
    });
    return picture;
  }

 private:
  void bake_row(int y, Picture& picture) const {
    int current = -1;
    OnTriangle map;
    for (int x = 0; x < atlas_.size; ++x) {
      const int t = atlas_.owner(x, y);
      if (t < 0) continue;
      if (t != current) map = OnTriangle(mesh_, atlas_.charts, current = t);
      double u = map.u(x + 0.5, y + 0.5), v = map.v(x + 0.5, y + 0.5);
      Colour colour = drawings_.mean_at(paints_[t], map.point(u, v), map.across(), map.down());
      // Texels of triangles that lie between the centres stay within them.
      u = std::clamp(u, 0.0, 1.0), v = std::clamp(v, 0.0, 1.0 - u);
      const double weights[] = {1 - u - v, u, v};
      for (int k = 0; k < 3; ++k)
        if (const int corner = corners_.corners[t][k]; corner >= 0)
          colour += static_cast<float>(weights[k]) * corners_.colours[corner];
      picture(x, y) = {to_byte(colour[0]), to_byte(colour[1]), to_byte(colour[2]), 255};
    }
  }

  const Mesh& mesh_;
  const Atlas& atlas_;
  const std::vector<Paint>& paints_;
  const Drawings& drawings_;
  const CornerColours& corners_;
};

// One ring more: texels beside coloured ones take the first of theirs, sides before corners.
void dilate(Picture& picture, std::vector<char>& coloured, std::vector<int>& rim) {
  static constexpr int kSteps[][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
  std::vector<int> next;
  for (const int i : rim)
    for (const auto [dx, dy] : kSteps) {
      const int x = i % picture.width + dx, y = i / picture.width + dy;
      if (!picture.contains(x, y)) continue;
      const int j = y * picture.width + x;
      if (coloured[j]) continue;
      coloured[j] = 1;
      picture.pixels[j] = picture.pixels[i];
      next.push_back(j);
    }
  rim = std::move(next);
}

Rgba mean_of(const Picture& picture, const Raster<int>& owner) {
  std::uint64_t r = 0, g = 0, b = 0, count = 0;
  for (std::size_t i = 0; i < owner.pixels.size(); ++i) {
    if (owner.pixels[i] < 0) continue;
    const Rgba p = picture.pixels[i];
    r += p.r, g += p.g, b += p.b, ++count;
  }
  const auto mean = [&](std::uint64_t sum) {
    return static_cast<std::uint8_t>((sum + count / 2) / std::max<std::uint64_t>(1, count));
  };
  return {mean(r), mean(g), mean(b), 255};
}

}  // namespace

Picture bake(const Mesh& mesh, const Atlas& atlas, const std::vector<Paint>& paints, const Drawings& drawings,
             const CornerColours& corners, int gutter) {
  Picture picture = Baker(mesh, atlas, paints, drawings, corners).bake();
  const Rgba mean = mean_of(picture, atlas.owner);
  const int width = atlas.size;
  std::vector<char> coloured(picture.pixels.size());
  std::vector<int> rim;
  for (int i = 0; i < static_cast<int>(picture.pixels.size()); ++i) coloured[i] = atlas.owner.pixels[i] >= 0;
  for (int y = 0; y < width; ++y)
    for (int x = 0; x < width; ++x) {
      const auto free = [&](int u, int v) { return picture.contains(u, v) && !coloured[v * width + u]; };
      if (coloured[y * width + x] && (free(x - 1, y) || free(x + 1, y) || free(x, y - 1) || free(x, y + 1)))
        rim.push_back(y * width + x);
    }
  for (int ring = 0; ring < gutter; ++ring) dilate(picture, coloured, rim);
  for (std::size_t i = 0; i < coloured.size(); ++i)
    if (!coloured[i]) picture.pixels[i] = mean;
  return picture;
}

}  // namespace carve
