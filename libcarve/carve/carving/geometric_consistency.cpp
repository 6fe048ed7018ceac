#include "carve/carving/geometric_consistency.h"

#include <algorithm>
#include <chrono>

#include "carve/carving/as_printed.h"
#include "carve/carving/cell_alternatives.h"
#include "carve/carving/cell_solver.h"
#include "carve/carving/silhouette_cover.h"
#include "carve/core/error.h"
#include "carve/core/options.h"
#include "carve/core/parallel.h"

namespace carve {
namespace {

/// The grid on which cells are decided, and the decision's place on the grid of the hull.
struct Cut {
  std::vector<RegionMap> regions;
  Cells cells;
  CellProblem hull;  // all cells kept
  Cells fine;        // on the hull's grid; its last cell may be one that is always kept
};

struct Input {
  const Carving& hull;
  std::span<const RegionMap> regions;
  const ConsistencyOptions& options;
  SearchLimit limit;
  const Cut* cut;  // for the arms that decide cells
};

std::vector<RegionMap> regions_of(const ViewSet& views, const VoxelGrid& hull, const RegionOptions& options) {
  std::vector<RegionMap> regions(views.views.size());
  parallel_ranges(0, static_cast<int>(regions.size()), 1, [&](int first, int last) {
    for (int v = first; v < last; ++v) regions[v] = find_regions(views.views[v], hull, options);
  });
  return regions;
}

/// The hull on the grid of the decision; nothing where that is the hull's own, or too coarse for any voxel.
std::optional<VoxelGrid> other_grid(const VoxelGrid& hull, const ViewSet& views, std::optional<int> grid) {
  if (!grid || *grid == hull.size().maxCoeff()) return {};
  try {
    return carve_silhouettes(views, {.grid = *grid}).grid;
  } catch (const NoResult&) {
    return {};
  }
}

Cut cut_hull(const VoxelGrid& hull, std::span<const RegionMap> regions, const ViewSet& views,
             const ConsistencyOptions& options) {
  const std::optional<VoxelGrid> other = other_grid(hull, views, options.grid);
  std::vector<RegionMap> cut =
      other ? regions_of(views, *other, options.regions) : std::vector<RegionMap>(regions.begin(), regions.end());
  Cells cells = partition(other ? *other : hull, cut);
  CellProblem problem(cells, cut, options.weights);
  Cells fine = other ? transfer(cells, *other, hull, regions) : cells;
  return {std::move(cut), std::move(cells), std::move(problem), std::move(fine)};
}

/// The cells' voxels, for those that are open.
std::vector<OpenCell> boxes_of(const Cells& cells, std::span<const int> open, std::span<const std::uint8_t> keep) {
  std::vector<int> place(cells.count, -1);
  std::vector<OpenCell> out;
  for (const int c : open) {
    if (cells.volume[c] == 0) continue;
    place[c] = static_cast<int>(out.size());
    out.push_back({cells.volume[c], keep[c] != 0, Vec3i::Constant(kLargestGrid), Vec3i::Zero()});
  }
  for (const CellRun& run : cells.runs)
    if (place[run.cell] >= 0) {
      OpenCell& cell = out[place[run.cell]];
      cell.low = cell.low.cwiseMin(Vec3i(run.x0, run.y, run.z));
      cell.high = cell.high.cwiseMax(Vec3i(run.x1, run.y + 1, run.z + 1));
      cell.runs.push_back(run);
    }
  return out;
}

ConsistencyResult as_printed(const Input& in) {
  return {.grid = carve_as_printed(in.hull), .ran = Consistency::as_printed};
}

/// What the problem's choice leaves of the hull, and what else explains the drawings as well.
ConsistencyResult chosen(const Input& in, CellProblem& problem, ConsistencyResult out) {
  const Cells& fine = in.cut->fine;
  std::vector<std::uint8_t> keep(problem.keep().begin(), problem.keep().end());
  keep.resize(fine.count, 1);
  out.cells = problem.cells();
  out.grid = assemble(in.hull.grid, fine, keep);
  const Alternatives others = find_alternatives(problem, in.options.alternatives);
  out.solids = others.solids;
  out.all_solids = others.all;
  out.open_cells = boxes_of(fine, others.cells, keep);
  return out;
}

ConsistencyResult two_level(const Input& in) {
  CellProblem problem = in.cut->hull;
  const std::int64_t nodes = drop_in_one_pass(problem);
  restore_unexplained(problem);
  return chosen(in, problem, {.ran = Consistency::two_level, .nodes = nodes});
}

/// The search, or one pass where that ends lower: a search that was cut short may.
ConsistencyResult solver(const Input& in) {
  CellProblem problem = in.cut->hull, other = problem;
  const SearchEnd end = search_cells(problem, in.cut->cells, in.limit);
  const std::int64_t nodes = end.nodes + drop_in_one_pass(other);
  const bool fallen_back = other.energy() < problem.energy();
  if (fallen_back) problem = std::move(other);
  restore_unexplained(problem);
  return chosen(
      in, problem,
      {.ran = fallen_back ? Consistency::two_level : Consistency::solver, .nodes = nodes, .in_time = end.in_time});
}

using Arm = ConsistencyResult (*)(const Input&);
constexpr Arm kArms[] = {nullptr, as_printed, two_level,
                         solver};  // in the order of Consistency; none has nothing to do

}  // namespace

ConsistencyResult apply_consistency(const Carving& hull, const ViewSet& views, const ConsistencyOptions& options,
                                    const Monitor& monitor) {
  check("consistency", options);
  monitor.at("consistency", 0);
  if (options.arm == Consistency::none) return {.grid = hull.grid};
  const std::vector<RegionMap> regions = regions_of(views, hull.grid, options.regions);
  std::vector<View> names;
  for (const AlignedView& view : views.views) names.push_back(view.view);
  ConsistencyResult result;
  result.grid = hull.grid;
  for (const RegionMap& map : regions) result.regions += map.count;
  result.hull_score = result.score = score_strokes(hull.grid, regions);
  monitor.at("consistency", 0.3);

  std::optional<Cut> cut;
  if (options.arm != Consistency::as_printed) cut = cut_hull(hull.grid, regions, views, options);
  Input in{hull, regions, options, {options.nodes, {}}, cut ? &*cut : nullptr};
  const auto start = std::chrono::steady_clock::now();
  if (options.seconds)
    in.limit.until = start + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                 std::chrono::duration<double>(*options.seconds));
  const auto checked = [&](Consistency arm) {
    ConsistencyResult carved = kArms[static_cast<int>(arm)](in);
    if (options.self_check) carved.grid = cover_silhouettes(std::move(carved.grid), hull.grid, names);
    carved.score = score_strokes(carved.grid, regions);
    return carved;
  };
  const auto fits = [&](const ConsistencyResult& carved) {
    return !options.self_check || carved.score.explains_more_than(result.hull_score);
  };
  ConsistencyResult carved = checked(options.arm);
  if (!fits(carved) && carved.ran == Consistency::solver) {
    const ConsistencyResult rejected = std::move(carved);
    carved = checked(Consistency::two_level);
    carved.nodes += rejected.nodes;
    carved.in_time = rejected.in_time;
  }
  if (!fits(carved)) {
    carved.ran = Consistency::none;
    carved.score = result.hull_score;
    if (carved.grid != hull.grid) {  // the record is that of another solid
      carved.grid = hull.grid;
      carved.solids = 1;
      carved.all_solids = false;
      carved.open_cells.clear();
    }
  }
  carved.regions = result.regions;
  carved.hull_score = result.hull_score;
  carved.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  monitor.at("consistency", 0.9);
  return carved;
}

}  // namespace carve
