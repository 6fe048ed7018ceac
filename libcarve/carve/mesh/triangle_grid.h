#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "carve/mesh/mesh.h"

namespace carve {

/// Triangles by the cells of a coarse grid that they reach into: what is near one of them is found without looking at
/// the others. Vertices may move, each within the box that its position and another one span.
class TriangleGrid {
 public:
  /// \param mesh  whose positions are at one end \param other  one a vertex, at the other
  TriangleGrid(const Mesh& mesh, std::span<const Vec3> other);

  /// The largest coordinate there may be, without its sign.
  double largest() const { return largest_; }

  /// Calls use(t) for each triangle that shares a cell with a box, once a cell.
  template <class Use>
  void each_near(const Vec3& low, const Vec3& high, Use&& use) const {
    each_cell(cells_of(low, high), [&](std::size_t cell) {
      for (std::uint32_t k = first_[cell]; k < first_[cell + 1]; ++k) use(triangles_[k]);
    });
  }

 private:
  struct CellBox {
    std::array<std::uint8_t, 3> low, high;
  };
  template <class Use>
  void each_cell(const CellBox& box, Use&& use) const {
    for (int z = box.low[2]; z <= box.high[2]; ++z)
      for (int y = box.low[1]; y <= box.high[1]; ++y)
        for (int x = box.low[0]; x <= box.high[0]; ++x) use((static_cast<std::size_t>(z) * side_ + y) * side_ + x);
  }
  CellBox cells_of(const Vec3& low, const Vec3& high) const;

  int side_ = 1;
  Vec3 low_ = Vec3::Zero();
  double cells_per_unit_ = 0, largest_ = 0;
  std::vector<std::uint32_t> first_;  // of each cell; one more at the end
  std::vector<int> triangles_;
};

}  // namespace carve
