#include "carve/mesh/triangle_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace carve {

TriangleGrid::TriangleGrid(const Mesh& mesh, std::span<const Vec3> other) {
  // A surface reaches into about as many cells as a cube's sides have: a few triangles to each.
  side_ = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(mesh.triangles.size()) / 16)), 1, 128);
  low_ = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = -low_;
  for (const std::span<const Vec3> positions : {std::span<const Vec3>(mesh.positions), other})
    for (const Vec3& p : positions) low_ = low_.cwiseMin(p), high = high.cwiseMax(p);
  if (other.empty()) low_ = high = Vec3::Zero();
  const double longest = (high - low_).maxCoeff();
  largest_ = std::max(-low_.minCoeff(), high.maxCoeff());
  cells_per_unit_ = longest > 1e-100 ? side_ / longest : 0;

  std::vector<CellBox> of_vertex;
  of_vertex.reserve(other.size());
  for (std::size_t v = 0; v < other.size(); ++v)
    of_vertex.push_back(cells_of(mesh.positions[v].cwiseMin(other[v]), mesh.positions[v].cwiseMax(other[v])));
  const auto each_cell_of = [&](const Triangle& triangle, auto&& use) {
    CellBox cells = of_vertex[triangle[0]];
    for (const int v : {triangle[1], triangle[2]})
      for (int k = 0; k < 3; ++k) {
        cells.low[k] = std::min(cells.low[k], of_vertex[v].low[k]);
        cells.high[k] = std::max(cells.high[k], of_vertex[v].high[k]);
      }
    each_cell(cells, use);
  };
  first_.assign(static_cast<std::size_t>(side_) * side_ * side_ + 1, 0);
  for (const Triangle& triangle : mesh.triangles) each_cell_of(triangle, [&](std::size_t cell) { ++first_[cell + 1]; });
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  triangles_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    each_cell_of(mesh.triangles[t], [&](std::size_t cell) { triangles_[next[cell]++] = static_cast<int>(t); });
}

TriangleGrid::CellBox TriangleGrid::cells_of(const Vec3& low, const Vec3& high) const {
  const auto cell = [&](double place, int k) {
    return static_cast<std::uint8_t>(std::clamp((place - low_[k]) * cells_per_unit_, 0.0, side_ - 1.0));
  };
  CellBox out;
  for (int k = 0; k < 3; ++k) out.low[k] = cell(low[k], k), out.high[k] = cell(high[k], k);
  return out;
}

}  // namespace carve
