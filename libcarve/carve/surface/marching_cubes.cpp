#include "carve/surface/marching_cubes.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <limits>
#include <stdexcept>
#include <utility>

#include "carve/core/pages.h"
#include "carve/core/parallel.h"
#include "carve/surface/cube_table.h"

namespace carve {
namespace {

// The cell (cx, cy, cz) has the voxel centres (cx - 1 .. cx, cy - 1 .. cy, cz - 1 .. cz) as corners; cells run from 0
// to the grid's size, so that a layer of them reaches half out of the grid on every side. A cell owns the three grid
// edges that end in its upper corner. Along a row of cells, vertices are numbered as the scan passes them: each of the
// eight kinds of edges that end at cx has a counter, and the edges that end at cx - 1 are the ones counted last.

constexpr int kCounters = 8;                                    // edges ending at cx:
constexpr int kCounted[kCounters] = {0, 1, 2, 3, 5, 7, 9, 11};  // along x; y; z (surface/cube_table.h)
constexpr int kPassed[4] = {4, 6, 8, 10};                       // those at cx - 1: y, z
constexpr int kOwnedX = 3, kOwnedY = 7, kOwnedZ = 11;           // edges
constexpr int kUpperCorner = 7;                                 // where they end
constexpr int kMostWords = kLargestGrid / 64 + 1;               // of a row of cells

using Counters = std::array<int, kCounters>;

/// What the scan needs to know of each case, beside its triangles.
struct Case {
  Counters step;        // vertices that the counters pass
  std::uint64_t owned;  // number of owned vertices along x, y, z and of triangles, 16 bits each
  std::uint8_t triangles;
  std::array<std::uint8_t, 15> slots;  // of the triangles' corners: counters, then passed edges
};

const std::array<Case, 256>& cases() {
  static const auto all = [] {
    std::array<Case, 256> all{};
    for (int inside = 0; inside < 256; ++inside) {
      const CubeCase& cube = cube_table()[inside];
      const auto cut = [&](int edge) -> int {
        const auto [a, b] = cube_edge(edge);
        return (inside >> a ^ inside >> b) & 1;
      };
      std::array<int, 12> slot_of_edge{};
      Case& c = all[inside];
      for (int k = 0; k < kCounters; ++k) c.step[k] = cut(kCounted[k]), slot_of_edge[kCounted[k]] = k;
      for (int k = 0; k < 4; ++k) slot_of_edge[kPassed[k]] = kCounters + k;
      for (int t = 0; t < cube.triangles; ++t)
        for (int k = 0; k < 3; ++k) c.slots[3 * t + k] = static_cast<std::uint8_t>(slot_of_edge[cube.edges[t][k]]);
      c.triangles = cube.triangles;
      c.owned = std::uint64_t(cut(kOwnedX)) | std::uint64_t(cut(kOwnedY)) << 16 | std::uint64_t(cut(kOwnedZ)) << 32 |
                std::uint64_t{cube.triangles} << 48;
    }
    return all;
  }();
  return all;
}

struct Row {
  int x = 0, y = 0, z = 0;  // owned vertices on edges along x, y, z: their number, then the first one's index
  int cells = 0;            // active cells
};

/// A layer of cells of one cz.
struct Layer {
  std::vector<std::uint32_t> cells;  // the active ones, row by row: cx << 8 | case
  std::int64_t vertices = 0, triangles = 0;
};

/// A bit for every cell of a row whose eight corners are not all alike.
void find_active(const std::uint64_t* const corners[4], int words_per_row, int words, std::uint64_t* active) {
  std::uint64_t any[kMostWords + 1], all[kMostWords + 1];
  any[0] = all[0] = any[words] = all[words] = 0;
  for (int w = 0; w < words_per_row; ++w) {
    const std::uint64_t a = corners[0][w], b = corners[1][w], c = corners[2][w], d = corners[3][w];
    any[w + 1] = a | b | c | d;
    all[w + 1] = a & b & c & d;
  }
  for (int w = 0; w < words; ++w)
    active[w] = (any[w + 1] | any[w + 1] << 1 | any[w] >> 63) & ~(all[w + 1] & (all[w + 1] << 1 | all[w] >> 63));
}

/// Where on an edge its vertex lies, from the lower centre: at the nearest crossing seen from the inside one.
double share(bool upper_inside, std::array<float, 4> crossings) {
  const float sign = upper_inside ? -1.f : 1.f;
  float nearest = 1;
  for (const float crossing : crossings)
    if (const float distance = sign * crossing; distance > 0) nearest = std::min(nearest, distance);
  const double distance = nearest < 1 ? nearest : 0.5f;
  return upper_inside ? 1 - distance : distance;
}

/// Puts the vertices that the cells of one row own.
class RowPlaces {
 public:
  RowPlaces(const VoxelGrid& grid, const Crossings& crossings, const std::vector<float>& nothing, int cy, int cz)
      : crossings_(crossings), spacing_(grid.spacing()), low_(grid.low()), cy_(cy), cz_(cz) {
    const auto row = [&](const Raster<float>& plane, int j) {
      return plane.empty() || j >= plane.height ? nothing.data() : &plane(0, j);
    };
    const auto entry = [](const Raster<float>& plane, int i, int j) { return plane.contains(i, j) ? plane(i, j) : 0; };
    along_x_ = {row(crossings.xy.first, cy), row(crossings.xz.first, cz)};
    along_y_ = row(crossings.xy.second, cy);
    along_z_ = row(crossings.xz.second, cz);
    side_y_ = entry(crossings.yz.first, cy, cz);
    side_z_ = entry(crossings.yz.second, cy, cz);
  }

  Vec3 x(int cx, bool upper) const {
    return place(cx + share(upper, {along_x_[0][cx], along_x_[1][cx], rounded(0, cx), stroke(0, cx)}) - 1, cy_, cz_);
  }
  Vec3 y(int cx, bool upper) const {
    return place(cx, cy_ + share(upper, {along_y_[cx], side_y_, rounded(1, cx), stroke(1, cx)}) - 1, cz_);
  }
  Vec3 z(int cx, bool upper) const {
    return place(cx, cy_, cz_ + share(upper, {along_z_[cx], side_z_, rounded(2, cx), stroke(2, cx)}) - 1);
  }

 private:
  Vec3 place(double x, double y, double z) const {
    return {low_.x() + spacing_ * (x + 0.5), low_.y() + spacing_ * (y + 0.5), low_.z() + spacing_ * (z + 0.5)};
  }
  float rounded(int axis, int cx) const { return crossings_.edges[axis](cx, cy_, cz_); }
  float stroke(int axis, int cx) const { return crossings_.strokes[axis](cx, cy_, cz_); }
  const Crossings& crossings_;
  double spacing_;
  Vec3 low_;
  int cy_, cz_;
  std::array<const float*, 2> along_x_;
  const float *along_y_, *along_z_;
  float side_y_, side_z_;
};

void check_size(const PlaneCrossings& plane, int first, int second) {
  const auto fits = [](const Raster<float>& raster, int width, int height) {
    return raster.empty() || (raster.width == width && raster.height == height);
  };
  if (!fits(plane.first, first + 1, second) || !fits(plane.second, first, second + 1))
    throw std::invalid_argument("crossings must be of the grid that is meshed");
}

class MarchingCubes {
 public:
  MarchingCubes(const VoxelGrid& grid, const Crossings& crossings)
      : grid_(grid),
        crossings_(crossings),
        size_(grid.size()),
        words_(size_.x() / 64 + 1),
        empty_row_(words_, 0),
        no_crossings_(size_.x() + 1, 0.f),
        rows_(static_cast<std::size_t>(size_.y() + 1) * (size_.z() + 1)),
        layers_(size_.z() + 1) {}

  Mesh mesh() {
    const int layers = static_cast<int>(layers_.size());
    parallel_ranges(0, layers, 1, [&](int first, int last) {
      for (int z = first; z < last; ++z) classify(z);
    });
    const auto [vertices, triangles] = number();
    Mesh mesh;
    resize_on_huge_pages(mesh.positions, vertices);
    resize_on_huge_pages(mesh.triangles, triangles);
    parallel_ranges(0, layers, 1, [&](int first, int last) {
      for (int z = first; z < last; ++z) fill(z, mesh);
    });
    return mesh;
  }

 private:
  const std::uint64_t* voxels(int y, int z) const {
    return y >= 0 && z >= 0 && y < size_.y() && z < size_.z() ? grid_.row(y, z) : empty_row_.data();
  }
  Row& row(int y, int z) { return rows_[static_cast<std::size_t>(z) * (size_.y() + 1) + y]; }

  /// Pass 1: finds and counts the layer's active cells.
  void classify(int z) {
    const std::array<Case, 256>& cases = carve::cases();
    std::vector<std::uint32_t> found(size_.x() + 1);
    for (int y = 0; y <= size_.y(); ++y) {
      const std::uint64_t* const corners[] = {voxels(y - 1, z - 1), voxels(y, z - 1), voxels(y - 1, z), voxels(y, z)};
      std::uint64_t active[kMostWords], owned = 0;
      find_active(corners, grid_.words_per_row(), words_, active);
      std::uint32_t* end = found.data();
      for (int w = 0; w < words_; ++w) {
        if (!active[w]) continue;
        std::uint64_t high[4], low[4];
        for (int k = 0; k < 4; ++k) {
          high[k] = w < grid_.words_per_row() ? corners[k][w] : 0;
          low[k] = high[k] << 1 | (w > 0 ? corners[k][w - 1] >> 63 : 0);
        }
        for (std::uint64_t rest = active[w]; rest; rest &= rest - 1) {
          const int b = std::countr_zero(rest);
          std::uint32_t inside = 0;
          for (int k = 0; k < 4; ++k) inside |= (low[k] >> b & 1) << 2 * k | (high[k] >> b & 1) << (2 * k + 1);
          *end++ = static_cast<std::uint32_t>(64 * w + b) << 8 | inside;
          owned += cases[inside].owned;
        }
      }
      const auto part = [&](int k) { return static_cast<int>(owned >> 16 * k & 0xffff); };
      row(y, z) = {part(0), part(1), part(2), static_cast<int>(end - found.data())};
      layers_[z].vertices += part(0) + part(1) + part(2);
      layers_[z].triangles += part(3);
      layers_[z].cells.insert(layers_[z].cells.end(), found.data(), end);
    }
    // Checked here, before the cells of a hopeless grid fill the memory.
    if ((vertices_ += layers_[z].vertices) > std::numeric_limits<int>::max())
      throw std::length_error("a mesh can have at most 2147483647 vertices, this grid's has more");
  }

  /// Turns the rows' and layers' counts into first indices. \return vertices and triangles of the mesh
  std::pair<std::size_t, std::size_t> number() {
    std::int64_t triangles = 0;
    for (Layer& layer : layers_) triangles += std::exchange(layer.triangles, triangles);
    int next = 0;
    for (Row& row : rows_)
      for (int* index : {&row.x, &row.y, &row.z}) next += std::exchange(*index, next);
    return {vertices_, triangles};
  }

  /// Pass 2: writes the layer's triangles and the vertices its cells own.
  void fill(int z, Mesh& mesh) {
    const std::array<Case, 256>& cases = carve::cases();
    const std::uint32_t* cell = layers_[z].cells.data();
    Triangle* triangle = mesh.triangles.data() + layers_[z].triangles;
    const Row none;
    for (int y = 0; y <= size_.y(); ++y) {
      const Row& row = this->row(y, z);
      if (row.cells == 0) continue;
      const Row& below = y > 0 ? this->row(y - 1, z) : none;
      const Row& behind = z > 0 ? this->row(y, z - 1) : none;
      const Row& both = y > 0 && z > 0 ? this->row(y - 1, z - 1) : none;
      Counters next{both.x, behind.x, below.x, row.x, behind.y, row.y, below.z, row.z};
      const RowPlaces places(grid_, crossings_, no_crossings_, y, z);
      for (const std::uint32_t* end = cell + row.cells; cell < end; ++cell) {
        const Case& c = cases[*cell & 0xff];
        int vertices[kCounters + 4];
        for (int k = 0; k < kCounters; ++k) vertices[k] = next[k];
        for (int k = 0; k < 4; ++k) vertices[kCounters + k] = next[4 + k] - 1;
        for (int t = 0; t < 3 * c.triangles; t += 3)
          *triangle++ = {vertices[c.slots[t]], vertices[c.slots[t + 1]], vertices[c.slots[t + 2]]};

        const int cx = static_cast<int>(*cell >> 8);
        const bool upper = *cell >> kUpperCorner & 1;
        if (c.step[3]) mesh.positions[next[3]] = places.x(cx, upper);
        if (c.step[5]) mesh.positions[next[5]] = places.y(cx, upper);
        if (c.step[7]) mesh.positions[next[7]] = places.z(cx, upper);
        for (int k = 0; k < kCounters; ++k) next[k] += c.step[k];
      }
    }
  }

  const VoxelGrid& grid_;
  const Crossings& crossings_;
  Vec3i size_;
  int words_;  // of a row of cells
  std::vector<std::uint64_t> empty_row_;
  std::vector<float> no_crossings_;
  std::vector<Row, PageAllocator<Row>> rows_;
  std::vector<Layer> layers_;
  std::atomic<std::int64_t> vertices_ = 0;
};

}  // namespace

Mesh marching_cubes(const VoxelGrid& grid, const Crossings& crossings) {
  const Vec3i& n = grid.size();
  check_size(crossings.xy, n.x(), n.y());
  check_size(crossings.xz, n.x(), n.z());
  check_size(crossings.yz, n.y(), n.z());
  for (const AxisCrossings* all : {&crossings.edges, &crossings.strokes})
    for (const EdgeCrossings& edges : *all)
      if (!edges.first.empty() && edges.size != n)
        throw std::invalid_argument("crossings must be of the grid that is meshed");
  return MarchingCubes(grid, crossings).mesh();
}

}  // namespace carve
