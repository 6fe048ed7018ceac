#include "carve/carving/scale_axis.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "carve/core/lower_envelope.h"
#include "carve/core/parallel.h"

namespace carve {
namespace {

constexpr int kCells = 64;  // along the longest side, to the nearest whole width in voxels

/// How voxels fall on cells `width` voxels wide that lie in their middle, so that a mirrored solid gives mirrored
/// cells. Cells are numbered from 1: an empty one lies at either end.
class Line {
 public:
  Line(int voxels, int width) : width_(width), count_((voxels + width - 1) / width), margin_(count_ * width - voxels) {}
  int cells() const { return count_ + 2; }
  /// Calls use(cell, halves) for the one or two cells that a voxel lies in, with the halves of it that do.
  template <class Use>
  void each(int voxel, Use&& use) const {
    const int low = 2 * voxel + margin_, cell = low / (2 * width_), first = std::min(2, 2 * width_ * (cell + 1) - low);
    use(cell + 1, first);
    if (first < 2) use(cell + 2, 2 - first);
  }
  /// The place of a voxel's centre among the cells' centres.
  float place(int voxel) const {
    return 1 + (static_cast<float>(2 * voxel + 1 + margin_) / static_cast<float>(2 * width_)) - 0.5f;
  }

 private:
  int width_, count_, margin_;  // the margin in halves of a voxel, on each side
};

struct CellGrid {
  Vec3i size;
  std::size_t index(int x, int y, int z) const { return (static_cast<std::size_t>(z) * size.y() + y) * size.x() + x; }
  std::size_t count() const { return static_cast<std::size_t>(size.x()) * size.y() * size.z(); }
};

/// Which cells the solid fills to at least one half.
std::vector<std::uint8_t> filled(const VoxelGrid& solid, const CellGrid& cells, const std::array<Line, 3>& lines,
                                 int width) {
  std::vector<int> eighths(cells.count(), 0), row(cells.size.x());
  for (int z = 0; z < solid.size().z(); ++z)
    for (int y = 0; y < solid.size().y(); ++y) {
      std::ranges::fill(row, 0);
      bool any = false;
      for (int w = 0; w < solid.words_per_row(); ++w)
        for (std::uint64_t rest = solid.row(y, z)[w]; rest; rest &= rest - 1) {
          lines[0].each(64 * w + std::countr_zero(rest), [&](int cell, int halves) { row[cell] += halves; });
          any = true;
        }
      if (!any) continue;
      lines[2].each(z, [&](int cz, int in_z) {
        lines[1].each(y, [&](int cy, int in_y) {
          int* to = &eighths[cells.index(0, cy, cz)];
          for (int x = 0; x < cells.size.x(); ++x) to[x] += in_z * in_y * row[x];
        });
      });
    }
  std::vector<std::uint8_t> out(cells.count());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = eighths[i] >= 4 * width * width * width;
  return out;
}

/// LowerEnvelope along all three axes.
void transform(std::vector<double>& values, const CellGrid& cells) {
  const std::size_t steps[] = {1, static_cast<std::size_t>(cells.size.x()),
                               static_cast<std::size_t>(cells.size.x()) * cells.size.y()};
  for (int axis = 0; axis < 3; ++axis) {
    const int u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2, n = cells.size[axis];
    parallel_ranges(0, cells.size[v], 4, [&](int first, int last) {
      LowerEnvelope envelope(n);
      std::vector<double> line(n), out(n);
      for (int j = first; j < last; ++j)
        for (int i = 0; i < cells.size[u]; ++i) {
          double* at = &values[i * steps[u] + j * steps[v]];
          for (int k = 0; k < n; ++k) line[k] = at[k * steps[axis]];
          envelope.apply(line, out);
          for (int k = 0; k < n; ++k) at[k * steps[axis]] = out[k];
        }
    });
  }
}

/// Raises each value to the largest of all, less the chamfer distance to it, in two scans.
void spread(std::vector<std::int32_t>& values, const CellGrid& cells, const std::array<std::int32_t, 3>& weights) {
  struct Neighbour {
    std::ptrdiff_t step;
    std::int32_t weight;
  };
  std::vector<Neighbour> before;  // of a cell, in the order of the scan
  for (int z = -1; z <= 0; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        if (z == 0 && (y > 0 || (y == 0 && x >= 0))) continue;
        const std::ptrdiff_t step = (static_cast<std::ptrdiff_t>(z) * cells.size.y() + y) * cells.size.x() + x;
        before.push_back({step, weights[std::abs(x) + std::abs(y) + std::abs(z) - 1]});
      }
  const auto scan = [&](bool forward) {
    const Vec3i last = cells.size - Vec3i::Constant(2);
    for (int k = 1; k <= last.z(); ++k)
      for (int j = 1; j <= last.y(); ++j)
        for (int i = 1; i <= last.x(); ++i) {
          const std::size_t at =
              forward ? cells.index(i, j, k) : cells.index(last.x() + 1 - i, last.y() + 1 - j, last.z() + 1 - k);
          std::int32_t largest = values[at];
          for (const Neighbour& n : before)
            largest = std::max(largest, values[forward ? at + n.step : at - n.step] - n.weight);
          values[at] = largest;
        }
  };
  scan(true);
  scan(false);
}

/// The balls that no other covers when all are `scale` times as large. \param squared  radii
std::vector<std::uint8_t> uncovered(const std::vector<double>& squared, const CellGrid& cells, double scale) {
  constexpr std::int32_t kCell = 60;  // units of a cell's side: whole numbers have no rounding
  constexpr std::array<std::int32_t, 3> kChamfer{60, 80, 100};  // to a neighbour by its face, edge and corner
  std::vector<std::int32_t> radius(squared.size());
  for (std::size_t i = 0; i < squared.size(); ++i)
    radius[i] = static_cast<std::int32_t>(std::lround(scale * kCell * std::sqrt(squared[i])));
  std::vector<std::int32_t> largest = radius;
  spread(largest, cells, kChamfer);
  std::vector<std::uint8_t> out(squared.size());
  for (std::size_t i = 0; i < out.size(); ++i)  // by more than half a cell, which the grid may have added
    out[i] = squared[i] > 0 && largest[i] <= radius[i] + kCell / 2;
  return out;
}

}  // namespace

ScaleAxis::ScaleAxis(const VoxelGrid& solid, double scale) : size_(solid.size()) {
  const int width = std::max(1, static_cast<int>(std::lround(static_cast<double>(size_.maxCoeff()) / kCells)));
  const std::array<Line, 3> lines{Line(size_.x(), width), Line(size_.y(), width), Line(size_.z(), width)};
  const CellGrid cells{{lines[0].cells(), lines[1].cells(), lines[2].cells()}};
  cells_ = cells.size;
  const std::vector<std::uint8_t> inside = filled(solid, cells, lines, width);
  std::vector<double> squared(cells.count());
  for (std::size_t i = 0; i < squared.size(); ++i) squared[i] = inside[i] ? LowerEnvelope::kNone : 0;
  const auto each_below = [&](auto&& use) {
    for (int z = 1; z + 1 < cells.size.z(); ++z)
      for (int x = 1; x + 1 < cells.size.x(); ++x) use(squared[cells.index(x, 0, z)], squared[cells.index(x, 1, z)]);
  };
  each_below([](double& below, double above) { below = above; });
  transform(squared, cells);
  each_below([](double& below, double) { below = 0; });
  const double largest = *std::ranges::max_element(squared);
  if (largest == 0) return;

  const std::vector<std::uint8_t> balls = uncovered(squared, cells, scale);
  for (std::size_t i = 0; i < squared.size(); ++i) squared[i] = balls[i] ? -squared[i] : LowerEnvelope::kNone;
  transform(squared, cells);
  for (const double power : squared) value_.push_back(static_cast<float>(1 + power / largest));
  std::vector<Between>* const places[] = {&x_, &y_, &z_};
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < size_[axis]; ++i) {
      const float place = lines[axis].place(i);
      const int cell = static_cast<int>(place);
      places[axis]->push_back({cell, place - static_cast<float>(cell)});
    }
}

void ScaleAxis::layer(int z, std::vector<float>& field) const {
  field.assign(static_cast<std::size_t>(size_.x()) * size_.y(), 0);
  if (value_.empty()) return;
  const int nx = cells_.x(), layer = nx * cells_.y();
  const Between& in_z = z_[z];
  std::vector<float> line(nx);
  for (int y = 0; y < size_.y(); ++y) {
    const Between& in_y = y_[y];
    const float* from = &value_[static_cast<std::size_t>(in_z.cell) * layer + in_y.cell * nx];
    for (int x = 0; x < nx; ++x)
      line[x] = (1 - in_z.share) * ((1 - in_y.share) * from[x] + in_y.share * from[x + nx]) +
                in_z.share * ((1 - in_y.share) * from[x + layer] + in_y.share * from[x + layer + nx]);
    for (int x = 0; x < size_.x(); ++x) {
      const Between& in_x = x_[x];
      field[static_cast<std::size_t>(y) * size_.x() + x] =
          (1 - in_x.share) * line[in_x.cell] + in_x.share * line[in_x.cell + 1];
    }
  }
}

}  // namespace carve
