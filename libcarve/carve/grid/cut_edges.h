#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "carve/core/parallel.h"
#include "carve/grid/edge_crossings.h"
#include "carve/grid/voxel_grid.h"

namespace carve {

/// Calls use(x) for the grid edges along `axis` that end in row (y, z), lie in `solid` and have one end in `part`.
template <class Use>
void each_cut_edge(const VoxelGrid& solid, const VoxelGrid& part, int axis, int y, int z, Use&& use) {
  const int dy = axis == 1, dz = axis == 2;
  if (y < dy || z < dz) return;
  const std::uint64_t *kept = part.row(y, z), *below = part.row(y - dy, z - dz);
  const std::uint64_t *inside = solid.row(y, z), *under = solid.row(y - dy, z - dz);
  for (int w = 0; w < solid.words_per_row(); ++w) {
    std::uint64_t cut = kept[w] ^ below[w], both = inside[w] & under[w];
    if (axis == 0) {
      cut = kept[w] ^ (kept[w] << 1 | (w > 0 ? kept[w - 1] >> 63 : 0));
      both = inside[w] & (inside[w] << 1 | (w > 0 ? inside[w - 1] >> 63 : 0));
    }
    for (std::uint64_t rest = cut & both; rest; rest &= rest - 1) use(64 * w + std::countr_zero(rest));
  }
}

/// Where the surface of `part` crosses the grid edges that lie in `solid`.
/// \param place_from  place_from(z) makes what knows the layers from z on, in turn: enter(z), then place(axis, upper,
/// upper_inside) for edges that end there, by their upper centre: voxels from the inside centre to the surface, in
/// (0, 1), or 0 where it does not know
template <class PlaceFrom>
AxisCrossings cut_edges(const VoxelGrid& solid, const VoxelGrid& part, PlaceFrom&& place_from) {
  struct Rows {  // of one layer and axis
    std::vector<std::uint32_t> ends;
    std::vector<EdgeCrossings::Entry> entries;
  };
  const Vec3i size = solid.size();
  std::vector<std::array<Rows, 3>> layers(size.z());
  parallel_ranges(0, size.z(), 8, [&](int first, int last) {
    auto place = place_from(first);
    for (int z = first; z < last; ++z) {
      place.enter(z);
      for (int axis = 0; axis < 3; ++axis) {
        Rows& rows = layers[z][axis];
        for (int y = 0; y < size.y(); ++y) {
          each_cut_edge(solid, part, axis, y, z, [&](int x) {
            const bool inside = part(x, y, z);
            if (const float distance = place(axis, Vec3i(x, y, z), inside); distance > 0)
              rows.entries.push_back({x, inside ? -distance : distance});
          });
          rows.ends.push_back(static_cast<std::uint32_t>(rows.entries.size()));
        }
      }
    }
  });
  AxisCrossings result;
  for (int axis = 0; axis < 3; ++axis) {
    EdgeCrossings& all = result[axis];
    all.size = size;
    all.first = {0};
    for (const std::array<Rows, 3>& rows : layers) {
      const std::uint32_t begin = static_cast<std::uint32_t>(all.entries.size());
      for (const std::uint32_t end : rows[axis].ends) all.first.push_back(begin + end);
      all.entries.insert(all.entries.end(), rows[axis].entries.begin(), rows[axis].entries.end());
    }
  }
  return result;
}

}  // namespace carve
