#include "carve/surface/marching_cubes.h"

#include <bit>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "carve/core/parallel.h"
#include "carve/surface/cube_table.h"

namespace carve {
namespace {

// The cell (cx, cy, cz) has the voxel centres (cx - 1 .. cx, cy - 1 .. cy, cz - 1 .. cz) as corners; cells run from 0
// to the grid's size, so that a layer of cells reaches half out of the grid on every side. A grid edge is named by its
// upper centre and its axis: the cell owns the three edges that end in its upper corner.

struct Row {
  int x = 0, y = 0, z = 0;  // owned edges with a vertex: their number, then the first one's index
  int cells = 0;            // active cells
};

/// A layer of cells of one cz.
struct Layer {
  std::vector<std::uint16_t> columns;  // cx of each active cell, row by row
  std::vector<std::uint8_t> cases;     // and its case
  std::int64_t vertices = 0, triangles = 0;
};

class MarchingCubes {
 public:
  MarchingCubes(const VoxelGrid& grid, const Crossings& crossings)
      : grid_(grid),
        crossings_(crossings),
        size_(grid.size()),
        empty_row_(grid.words_per_row(), 0),
        rows_(static_cast<std::size_t>(size_.y() + 1) * (size_.z() + 1)),
        layers_(size_.z() + 1) {}

  Mesh mesh() {
    const int layers = static_cast<int>(layers_.size());
    parallel_ranges(0, layers, 1, [&](int first, int last) {
      for (int z = first; z < last; ++z) classify(z);
    });
    Mesh mesh;
    const auto [vertices, triangles] = number();
    mesh.positions.resize(vertices);
    mesh.triangles.resize(triangles);
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

  /// Pass 1: finds the layer's active cells.
  void classify(int z) {
    for (int y = 0; y <= size_.y(); ++y) classify(y, z);
    for (std::uint8_t c : layers_[z].cases) layers_[z].triangles += cube_table()[c].triangles;
  }

  void classify(int y, int z) {
    const std::uint64_t* corner_rows[] = {voxels(y - 1, z - 1), voxels(y, z - 1), voxels(y - 1, z), voxels(y, z)};
    const int words = size_.x() / 64 + 1;
    Row& row = this->row(y, z);
    Layer& layer = layers_[z];
    std::uint64_t low[4], high[4] = {}, carry[4] = {};
    for (int w = 0; w < words; ++w) {
      std::uint64_t any = 0, all = ~std::uint64_t{0};
      for (int k = 0; k < 4; ++k) {
        carry[k] = high[k] >> 63;
        high[k] = w < grid_.words_per_row() ? corner_rows[k][w] : 0;
        low[k] = high[k] << 1 | carry[k];
        any |= high[k] | low[k];
        all &= high[k] & low[k];
      }
      std::uint64_t active = any & ~all;
      if (!active) continue;
      row.x += std::popcount(high[3] ^ low[3]);
      row.y += std::popcount(high[3] ^ high[2]);
      row.z += std::popcount(high[3] ^ high[1]);
      row.cells += std::popcount(active);
      for (; active; active &= active - 1) {
        const int b = std::countr_zero(active);
        unsigned inside = 0;
        for (int k = 0; k < 4; ++k) inside |= (low[k] >> b & 1) << 2 * k | (high[k] >> b & 1) << (2 * k + 1);
        layer.columns.push_back(static_cast<std::uint16_t>(64 * w + b));
        layer.cases.push_back(static_cast<std::uint8_t>(inside));
      }
    }
    layer.vertices += row.x + row.y + row.z;
  }

  /// Turns the rows' and layers' counts into first indices. \return vertices and triangles of the mesh
  std::pair<std::size_t, std::size_t> number() {
    const auto total = [&](auto member) {
      return std::accumulate(layers_.begin(), layers_.end(), std::int64_t{0},
                             [&](std::int64_t sum, const Layer& layer) { return sum + layer.*member; });
    };
    const std::int64_t vertices = total(&Layer::vertices);
    if (vertices > std::numeric_limits<int>::max())
      throw std::length_error("a mesh can have at most 2147483647 vertices, this grid's has " +
                              std::to_string(vertices));
    int next = 0;
    for (Row& row : rows_)
      for (int* index : {&row.x, &row.y, &row.z}) next += std::exchange(*index, next);
    std::int64_t next_triangle = 0;
    for (Layer& layer : layers_) next_triangle += std::exchange(layer.triangles, next_triangle);
    return {vertices, next_triangle};
  }

  /// Pass 2: writes the layer's triangles and the vertices its cells own.
  void fill(int z, Mesh& mesh) {
    const Layer& layer = layers_[z];
    std::size_t cell = 0;
    Triangle* triangle = mesh.triangles.data() + layer.triangles;
    for (int y = 0; y <= size_.y(); ++y) {
      const Row& row = this->row(y, z);
      const Row none;
      const Row& below = y > 0 ? this->row(y - 1, z) : none;
      const Row& behind = z > 0 ? this->row(y, z - 1) : none;
      const Row& both = y > 0 && z > 0 ? this->row(y - 1, z - 1) : none;
      // Next index of each of the cell's edges along the rows; edges at the lower x are those the row has just passed.
      int x[4] = {both.x, behind.x, below.x, row.x}, y_edges[2] = {behind.y, row.y}, z_edges[2] = {below.z, row.z};
      for (const std::size_t end = cell + row.cells; cell < end; ++cell) {
        const int edges[12] = {x[0],           x[1],       x[2],           x[3],        //
                               y_edges[0] - 1, y_edges[0], y_edges[1] - 1, y_edges[1],  //
                               z_edges[0] - 1, z_edges[0], z_edges[1] - 1, z_edges[1]};
        const unsigned inside = layer.cases[cell];
        const CubeCase& cube = cube_table()[inside];
        for (int t = 0; t < cube.triangles; ++t)
          *triangle++ = {edges[cube.edges[t][0]], edges[cube.edges[t][1]], edges[cube.edges[t][2]]};
        place(layer.columns[cell], y, z, inside, edges, mesh);
        const auto cut = [&](int a, int b) { return static_cast<int>((inside >> a ^ inside >> b) & 1); };
        for (int k = 0; k < 4; ++k) x[k] += cut(2 * k, 2 * k + 1);
        for (int k = 0; k < 2; ++k) y_edges[k] += cut(1 + 4 * k, 3 + 4 * k), z_edges[k] += cut(1 + 2 * k, 5 + 2 * k);
      }
    }
  }

  /// Positions of the vertices on the edges the cell owns.
  void place(int cx, int cy, int cz, unsigned inside, const int edges[12], Mesh& mesh) const {
    const auto is_inside = [&](int corner) { return (inside >> corner & 1) != 0; };
    const bool upper = is_inside(7);
    Vec3 centre(cx, cy, cz);  // of the lower corner, in voxels from the grid's lower corner + 1/2
    const auto put = [&](int axis, int edge, float a, float b) {
      Vec3 place = centre;
      place[axis] += share(!upper, a, b) - 1;
      mesh.positions[edges[edge]] = grid_.low() + grid_.spacing() * (place.array() + 0.5).matrix();
    };
    const auto& [xy, xz, yz] = crossings_;
    if (is_inside(6) != upper) put(0, 3, entry(xy.first, cx, cy), entry(xz.first, cx, cz));
    if (is_inside(5) != upper) put(1, 7, entry(xy.second, cx, cy), entry(yz.first, cy, cz));
    if (is_inside(3) != upper) put(2, 11, entry(xz.second, cx, cz), entry(yz.second, cy, cz));
  }

  static float entry(const Raster<float>& plane, int i, int j) { return plane.empty() ? 0 : plane(i, j); }

  /// Where on an edge its vertex lies, from the lower centre: at the nearest crossing seen from the inside one.
  static double share(bool lower_inside, float a, float b) {
    const float sign = lower_inside ? 1.f : -1.f;
    float nearest = 1;
    for (float crossing : {sign * a, sign * b})
      if (crossing > 0 && crossing < nearest) nearest = crossing;
    if (nearest == 1) nearest = 0.5f;
    return lower_inside ? nearest : 1.0 - nearest;
  }

  const VoxelGrid& grid_;
  const Crossings& crossings_;
  Vec3i size_;
  std::vector<std::uint64_t> empty_row_;
  std::vector<Row> rows_;
  std::vector<Layer> layers_;
};

}  // namespace

Mesh marching_cubes(const VoxelGrid& grid, const Crossings& crossings) { return MarchingCubes(grid, crossings).mesh(); }

}  // namespace carve
