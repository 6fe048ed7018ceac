#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <ostream>

#include "carve/mesh/neighbours.h"
#include "carve/mesh/uv_jacobian.h"
#include "eval/render.h"
#include "eval/texture_scores.h"

namespace carve {
namespace {

std::int64_t count_charts(const TexturedMesh& model) {
  std::vector<int> root(model.uvs.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  std::vector<char> used(root.size());
  for (const auto& [a, b, c] : model.uv_triangles) {
    used[a] = used[b] = used[c] = 1;
    root[find(a)] = find(b);
    root[find(c)] = find(b);
  }
  std::int64_t count = 0;
  for (std::size_t i = 0; i < root.size(); ++i) count += used[i] && root[i] == static_cast<int>(i);
  return count;
}

void score_distortion(const TexturedMesh& model, AtlasScores& scores) {
  struct Triangle2 {
    double area, stretch, shrink;  // squared norms of the Jacobian and of its inverse
  };
  std::vector<Triangle2> all;
  double area = 0, texture_area = 0;
  for (std::size_t t = 0; t < model.mesh.triangles.size(); ++t) {
    const auto& [i, k, l] = model.mesh.triangles[t];
    const Vec3 &a = model.mesh.positions[i], &b = model.mesh.positions[k], &c = model.mesh.positions[l];
    const double here = (b - a).cross(c - a).norm() / 2;
    if (here < 1e-14) continue;
    const auto& [at_a, at_b, at_c] = model.uv_triangles[t];
    const Eigen::Matrix2d j = uv_jacobian(a, b, c, model.uvs[at_a], model.uvs[at_b], model.uvs[at_c]);
    const double determinant = j.determinant();
    if (!(determinant > 1e-9)) {
      ++scores.flipped;
      continue;
    }
    all.push_back({here, j.squaredNorm(), j.inverse().squaredNorm()});
    area += here;
    texture_area += here * determinant;
  }
  scores.packing = texture_area;
  if (area == 0 || texture_area == 0) return;
  const double scale = area / texture_area;  // squared
  for (const Triangle2& t : all) scores.distortion += t.area / area * (t.stretch * scale + t.shrink / scale);
}

void score_seams(const TexturedMesh& model, AtlasScores& scores) {
  const auto neighbours = triangle_neighbours(model.mesh);
  double contrast = 0;
  for (int t = 0; t < static_cast<int>(neighbours.size()); ++t)
    for (int k = 0; k < 3; ++k) {
      const int other = neighbours[t][k];
      if (other <= t) continue;
      const int from = model.mesh.triangles[t][k], to = model.mesh.triangles[t][(k + 1) % 3];
      const auto uv = [&](int triangle, int vertex) {
        const Triangle& corners = model.mesh.triangles[triangle];
        return model.uv_triangles[triangle][corners[0] == vertex ? 0 : corners[1] == vertex ? 1 : 2];
      };
      const int a = uv(t, from), b = uv(t, to), c = uv(other, from), d = uv(other, to);
      if (a == c && b == d) continue;
      const double length = (model.mesh.positions[from] - model.mesh.positions[to]).norm();
      scores.seam_length += length;
      const Colour here = texture_at(model.texture, (model.uvs[a] + model.uvs[b]) / 2);
      const Colour there = texture_at(model.texture, (model.uvs[c] + model.uvs[d]) / 2);
      contrast += length * (here - there).norm();
    }
  if (scores.seam_length > 0) scores.seam_contrast = contrast / scores.seam_length;
}

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

void score_overlap(const TexturedMesh& model, AtlasScores& scores) {
  constexpr double kInside = 1e-5;  // of a triangle's height: neighbours share what lies on their edge
  for (const Vec2& uv : model.uvs) scores.outside += !(uv.minCoeff() >= 0 && uv.maxCoeff() <= 1);
  Mask covered(model.texture.width, model.texture.height);
  const Vec2 size(covered.width, covered.height);
  for (const auto& [i, j, k] : model.uv_triangles) {
    const Vec2 p[] = {model.uvs[i].cwiseProduct(size), model.uvs[j].cwiseProduct(size),
                      model.uvs[k].cwiseProduct(size)};
    const double area = cross(p[1] - p[0], p[2] - p[0]);
    if (area == 0 || !std::isfinite(area)) continue;
    const Vec2 low = p[0].cwiseMin(p[1]).cwiseMin(p[2]).cwiseMax(0);
    const Vec2 high = p[0].cwiseMax(p[1]).cwiseMax(p[2]).cwiseMin(size - Vec2::Ones());
    for (int y = static_cast<int>(low.y()); y <= high.y(); ++y)
      for (int x = static_cast<int>(low.x()); x <= high.x(); ++x) {
        const Vec2 centre(x + 0.5, y + 0.5);
        bool inside = true;
        for (int e = 0; e < 3; ++e) inside &= cross(p[(e + 1) % 3] - p[e], centre - p[e]) / area > kInside;
        if (!inside) continue;
        scores.overlap += covered(x, y) == 1;
        if (covered(x, y) < 2) ++covered(x, y);
      }
  }
}

}  // namespace

AtlasScores atlas_scores(const TexturedMesh& model) {
  AtlasScores scores;
  scores.charts = count_charts(model);
  score_distortion(model, scores);
  score_overlap(model, scores);
  score_seams(model, scores);
  return scores;
}

std::ostream& operator<<(std::ostream& out, const AtlasScores& s) {
  char text[500];
  std::snprintf(
      text, sizeof text,
      "charts           %lld\npacking          %.4f\ndistortion       %.4f   mean symmetric Dirichlet energy, 4 = "
      "isometric\nflipped          %lld\noverlap          %lld   texels in two triangles\noutside          %lld   "
      "coordinates not in [0, 1]\nseam length      %.4f\nseam contrast    %.3f   RGB distance\n",
      static_cast<long long>(s.charts), s.packing, s.distortion, static_cast<long long>(s.flipped),
      static_cast<long long>(s.overlap), static_cast<long long>(s.outside), s.seam_length, s.seam_contrast);
  return out << text;
}

}  // namespace carve
