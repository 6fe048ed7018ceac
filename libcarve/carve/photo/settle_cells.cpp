#include "carve/photo/settle_cells.h"

#include <stdexcept>

#include "carve/photo/silhouette_hull.h"

namespace carve {
namespace {

template <class Use>
void each_voxel(const OpenCell& cell, Use&& use) {
  for (const CellRun& run : cell.runs)
    for (int x = run.x0; x < run.x1; ++x) use(x, run.y, run.z);
}

void check_inside(const OpenCell& cell, const VoxelGrid& grid) {
  for (const CellRun& run : cell.runs)
    if (run.x0 < 0 || run.x1 > grid.size().x() || run.y < 0 || run.y >= grid.size().y() || run.z < 0 ||
        run.z >= grid.size().z())
      throw std::invalid_argument("an open cell does not lie in the grid");
}

}  // namespace

SettledCells settle_cells(std::span<const Photo> photos, const VoxelGrid& solid, std::span<const OpenCell> cells,
                          const SpaceCarvingOptions& options, const Monitor& monitor) {
  SettledCells result{.grid = solid};
  VoxelGrid open(solid.size(), solid.low(), solid.spacing()), start = solid;
  for (const OpenCell& cell : cells) {
    check_inside(cell, solid);
    if (cell.kept) each_voxel(cell, [&](int x, int y, int z) { open.set(x, y, z, solid(x, y, z)); });
  }
  // What no silhouette allows is gone at once; the rest of the solid stays, right or wrong.
  const VoxelGrid within = silhouette_hull(photos, open, monitor);
  for (std::size_t w = 0; w < start.words().size(); ++w) start.words()[w] &= ~open.words()[w] | within.words()[w];
  const VoxelGrid left = space_carving_within(photos, std::move(start), open, options, monitor).grid;
  for (const OpenCell& cell : cells) {
    if (!cell.kept) continue;
    std::int64_t count = 0, gone = 0;
    each_voxel(cell, [&](int x, int y, int z) { count += solid(x, y, z), gone += solid(x, y, z) && !left(x, y, z); });
    const bool keeps = 2 * gone <= count;
    ++(keeps ? result.kept : result.dropped);
    if (!keeps) each_voxel(cell, [&](int x, int y, int z) { result.grid.set(x, y, z, false); });
  }
  return result;
}

}  // namespace carve
