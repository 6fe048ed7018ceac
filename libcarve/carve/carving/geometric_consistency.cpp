#include "carve/carving/geometric_consistency.h"

#include <algorithm>

#include "carve/carving/as_printed.h"
#include "carve/carving/cell_solver.h"
#include "carve/carving/silhouette_cover.h"
#include "carve/core/options.h"
#include "carve/core/parallel.h"

namespace carve {
namespace {

struct Input {
  const Carving& hull;
  std::span<const RegionMap> regions;
  const ConsistencyOptions& options;
};

struct Carved {
  VoxelGrid grid;
  int cells = 0;
  std::int64_t nodes = 0;
};

Carved as_printed(const Input& in) { return {carve_as_printed(in.hull)}; }

/// Decides cells with `decide` and puts them together.
template <class Decide>
Carved by_cells(const Input& in, Decide&& decide) {
  const Vec3i& size = in.hull.grid.size();
  const Cells cells = partition(in.hull.grid, in.regions);
  CellProblem problem(cells, size, in.regions, in.options.weights);
  const std::int64_t nodes = decide(problem, cells);
  return {assemble(in.hull.grid, cells, problem.keep()), cells.count, nodes};
}

Carved two_level(const Input& in) {
  return by_cells(in, [](CellProblem& problem, const Cells&) { return drop_in_one_pass(problem); });
}

Carved solver(const Input& in) {
  return by_cells(in, [&](CellProblem& problem, const Cells& cells) {
    return search_cells(problem, cells, in.hull.grid.size(), in.regions, in.options.nodes);
  });
}

using Arm = Carved (*)(const Input&);
constexpr Arm kArms[] = {nullptr, as_printed, two_level,
                         solver};  // in the order of Consistency; none has nothing to do

}  // namespace

ConsistencyResult apply_consistency(const Carving& hull, const ViewSet& views, const ConsistencyOptions& options,
                                    const Monitor& monitor) {
  check("consistency", options);
  monitor.at("consistency", 0);
  if (options.arm == Consistency::none) return {.grid = hull.grid};
  std::vector<RegionMap> regions(views.views.size());
  std::vector<View> names;
  for (const AlignedView& view : views.views) names.push_back(view.view);
  parallel_ranges(0, static_cast<int>(regions.size()), 1, [&](int first, int last) {
    for (int v = first; v < last; ++v) regions[v] = find_regions(views.views[v], hull.grid, options.regions);
  });
  ConsistencyResult result;
  result.grid = hull.grid;
  for (const RegionMap& map : regions) result.regions += map.count;
  result.hull_score = result.score = score_strokes(hull.grid, regions);
  monitor.at("consistency", 0.3);

  Carved carved = kArms[static_cast<int>(options.arm)]({hull, regions, options});
  result.cells = carved.cells;
  result.nodes = carved.nodes;
  monitor.at("consistency", 0.9);
  if (options.self_check) carved.grid = cover_silhouettes(std::move(carved.grid), hull.grid, names);
  const StrokeScore score = score_strokes(carved.grid, regions);
  if (!options.self_check || score.value() > result.hull_score.value()) {
    result.grid = std::move(carved.grid);
    result.ran = options.arm;
    result.score = score;
  }
  return result;
}

}  // namespace carve
