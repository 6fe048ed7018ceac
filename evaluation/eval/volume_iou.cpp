#include "eval/volume_iou.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

#include "carve/core/parallel.h"

namespace carve {
namespace {

struct Grid {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = -low;
  double step = 1;
  Vec3i count = Vec3i::Ones();

  double centre(int axis, int i) const { return low[axis] + (i + 0.5) * step; }
};

Grid common_grid(const Mesh& a, const Mesh& b, int resolution) {
  Grid grid;
  for (const Mesh* mesh : {&a, &b})
    for (const Triangle& triangle : mesh->triangles)
      for (const int corner : triangle) {
        grid.low = grid.low.cwiseMin(mesh->positions[corner]);
        grid.high = grid.high.cwiseMax(mesh->positions[corner]);
      }
  const Vec3 size = grid.high - grid.low;
  if (!(size.maxCoeff() > 0)) return {};
  grid.step = size.maxCoeff() / resolution;
  for (int k = 0; k < 3; ++k) grid.count[k] = std::max(1, static_cast<int>(std::ceil(size[k] / grid.step - 1e-9)));
  return grid;
}

// Where a row leaves or enters a mesh: the winding number grows by `sign` beyond x.
struct Crossing {
  double x;
  int sign;
};

// Twice the area of the triangle (a, b, p) seen along x; exactly the negative of what (b, a, p) gives, so that
// neighbours agree on the side of a row at their common edge.
double area_seen(const Vec3& a, const Vec3& b, double y, double z) {
  const bool swapped = std::pair(b.y(), b.z()) < std::pair(a.y(), a.z());
  const Vec3 &s = swapped ? b : a, &e = swapped ? a : b;
  const double area = (e.y() - s.y()) * (z - s.z()) - (e.z() - s.z()) * (y - s.y());
  return swapped ? -area : area;
}

// Whether p lies on the left of edge ab; a p exactly on it counts for one of the edge's two directions only.
bool left_of(const Vec3& a, const Vec3& b, double area) {
  if (area != 0) return area > 0;
  return std::pair(a.y(), a.z()) < std::pair(b.y(), b.z());
}

// Rows with centres (y, z) of layers z0 <= z < z1, each with its sorted crossings.
class Rows {
 public:
  Rows(const Grid& grid, int z0, int z1) : grid_(grid), z0_(z0), z1_(z1), rows_((z1 - z0) * grid.count.y()) {}

  void add(const Mesh& mesh) {
    for (auto& row : rows_) row.clear();
    for (const auto& [a, b, c] : mesh.triangles) add(mesh.positions[a], mesh.positions[b], mesh.positions[c]);
    for (auto& row : rows_)
      std::sort(row.begin(), row.end(),
                [](const Crossing& l, const Crossing& r) { return std::pair(l.x, l.sign) < std::pair(r.x, r.sign); });
  }

  // 1 where the centre is inside, x fastest, then y, then z.
  void fill(std::vector<std::uint8_t>& inside) const {
    inside.assign(rows_.size() * grid_.count.x(), 0);
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      int winding = 0;
      std::size_t next = 0;
      for (int x = 0; x < grid_.count.x(); ++x) {
        for (; next < rows_[r].size() && rows_[r][next].x <= grid_.centre(0, x); ++next) winding += rows_[r][next].sign;
        inside[r * grid_.count.x() + x] = winding != 0;
      }
    }
  }

 private:
  int first_centre(int axis, double at) const {
    return static_cast<int>(std::ceil(std::max(0.0, (at - grid_.low[axis]) / grid_.step - 0.5 - 1e-9)));
  }

  void add(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double low_y = std::min({a.y(), b.y(), c.y()}), high_y = std::max({a.y(), b.y(), c.y()});
    const double low_z = std::min({a.z(), b.z(), c.z()}), high_z = std::max({a.z(), b.z(), c.z()});
    for (int k = std::max(z0_, first_centre(2, low_z)); k < z1_ && grid_.centre(2, k) <= high_z; ++k)
      for (int j = first_centre(1, low_y); j < grid_.count.y() && grid_.centre(1, j) <= high_y; ++j)
        cross(a, b, c, j, k);
  }

  void cross(const Vec3& a, const Vec3& b, const Vec3& c, int j, int k) {
    const double y = grid_.centre(1, j), z = grid_.centre(2, k);
    const double ab = area_seen(a, b, y, z), bc = area_seen(b, c, y, z), ca = area_seen(c, a, y, z);
    const bool left = left_of(a, b, ab);
    if (left_of(b, c, bc) != left || left_of(c, a, ca) != left) return;
    const double sum = ab + bc + ca;
    const double x = sum != 0 ? (bc * a.x() + ca * b.x() + ab * c.x()) / sum : (a.x() + b.x() + c.x()) / 3;
    rows_[(k - z0_) * grid_.count.y() + j].push_back({x, left ? -1 : 1});
  }

  const Grid& grid_;
  int z0_, z1_;
  std::vector<std::vector<Crossing>> rows_;
};

}  // namespace

double volume_iou(const Mesh& a, const Mesh& b, int resolution) {
  if (resolution < 1 || resolution > 2048)
    throw std::invalid_argument("IoU resolution must be in [1, 2048], got " + std::to_string(resolution));
  const Grid grid = common_grid(a, b, resolution);
  std::vector<std::int64_t> both(grid.count.z()), either(grid.count.z());
  parallel_ranges(0, grid.count.z(), 16, [&](int first, int last) {
    Rows rows(grid, first, last);
    std::vector<std::uint8_t> in_a, in_b;
    rows.add(a);
    rows.fill(in_a);
    rows.add(b);
    rows.fill(in_b);
    const std::size_t layer = in_a.size() / (last - first);
    for (std::size_t i = 0; i < in_a.size(); ++i) {
      both[first + i / layer] += in_a[i] & in_b[i];
      either[first + i / layer] += in_a[i] | in_b[i];
    }
  });
  std::int64_t intersection = 0, together = 0;
  for (int z = 0; z < grid.count.z(); ++z) intersection += both[z], together += either[z];
  return together ? static_cast<double>(intersection) / static_cast<double>(together) : 0;
}

}  // namespace carve
