#pragma once
#include <array>
#include <span>
#include <vector>

#include "carve/carving/regions.h"

namespace carve {

/// Voxels x0 <= x < x1 of row (y, z).
struct CellRun {
  int y, z, x0, x1, cell;
};

/// Where a cell is first met along a pixel's ray.
struct RayEntry {
  int cell;
  int depth;  // voxels from the box's face on the viewer's side
};

/// The cells behind each pixel of a view in the order in which its ray meets them, each once.
struct Rays {
  int width = 0, height = 0;
  std::vector<int> begin;  // width * height + 1 offsets into entries
  std::vector<RayEntry> entries;
  std::span<const RayEntry> operator()(int i, int j) const {
    const std::size_t p = static_cast<std::size_t>(j) * width + i;
    return std::span(entries).subspan(begin[p], begin[p + 1] - begin[p]);
  }
};

/// The hull cut into cells: connected sets of voxels that lie behind the same region of every view.
struct Cells {
  Vec3i size = Vec3i::Zero();  // of the hull's grid
  int count = 0;
  std::vector<CellRun> runs;                // by z, then y, then x
  std::vector<std::int64_t> volume;         // voxels per cell
  std::vector<std::array<int, 6>> regions;  // per cell, its region in each view; -1 past the last view
  std::vector<Rays> rays;                   // per view, as trace() makes them: partition() does not
};

/// \throws std::invalid_argument if there are more than six views
Cells partition(const VoxelGrid& hull, std::span<const RegionMap> views);

/// What the views' pixels meet.
std::vector<Rays> trace(const Cells& cells, std::span<const RegionMap> views);

/// Space that a cell shares with one of another grid's hull.
struct SharedSpace {
  int own, other;
  std::int64_t voxels;  // of the own grid
  bool operator==(const SharedSpace&) const = default;
};
/// By own cell, then the other.
std::vector<SharedSpace> shared_space(const Cells& own, const VoxelGrid& own_grid, const Cells& other,
                                      const VoxelGrid& other_grid);

/// Per own cell, whether more than half of the space that it shares lies in cells that are marked.
std::vector<std::uint8_t> mostly(std::span<const SharedSpace> shared, int own_count,
                                 std::span<const std::uint8_t> marked);

/// Voxel faces between two cells; b = -1: to the outside of the hull. a > b.
struct CellContact {
  int a, b;
  std::int64_t faces;
};
std::vector<CellContact> contacts(const Cells& cells);

/// The hull's voxels whose cell is kept.
VoxelGrid assemble(const VoxelGrid& hull, const Cells& cells, std::span<const std::uint8_t> keep);

}  // namespace carve
