#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "carve/core/vector.h"

namespace carve {

inline constexpr float kClearance = 0.02F;  // voxels between a crossing and the centres: no triangle degenerates

/// Where a surface crosses the grid edges along one axis, where that is known. An edge is named by its upper centre
/// (x, y, z). The value is as in surface/crossings.h: voxels from the inside centre to the surface, in (0, 1), positive
/// if that is the lower centre, negative if it is the upper one; 0 where nothing is known.
struct EdgeCrossings {
  struct Entry {
    int x;
    float distance;
  };
  Vec3i size = Vec3i::Zero();          // of the grid
  std::vector<std::uint32_t> first{};  // entry of row z * ny + y, one more at the end; empty: nothing is known
  std::vector<Entry> entries{};        // by row, then x

  float operator()(int x, int y, int z) const {
    if (first.empty() || y >= size.y() || z >= size.z()) return 0;
    const auto row = first.begin() + (static_cast<std::size_t>(z) * size.y() + y);
    const auto end = entries.begin() + row[1];
    const auto found =
        std::lower_bound(entries.begin() + row[0], end, x, [](const Entry& e, int at) { return e.x < at; });
    return found != end && found->x == x ? found->distance : 0;
  }
};

/// Along x, y and z.
using AxisCrossings = std::array<EdgeCrossings, 3>;

}  // namespace carve
