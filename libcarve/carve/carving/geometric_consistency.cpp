#include "carve/carving/geometric_consistency.h"

#include <algorithm>
#include <chrono>

#include "carve/carving/as_printed.h"
#include "carve/carving/cell_alternatives.h"
#include "carve/carving/cell_solver.h"
#include "carve/carving/silhouette_cover.h"
#include "carve/carving/stroke_crossings.h"
#include "carve/core/error.h"
#include "carve/core/options.h"
#include "carve/core/parallel.h"

namespace carve {
namespace {

/// The hull cut into cells on a grid on which they are decided.
struct Cut {
  std::vector<RegionMap> regions;
  Cells cells;
  CellProblem hull;  // all of them kept
  VoxelGrid grid;
  std::vector<SharedSpace> of_own;  // of the cells of the hull's own grid with these
  std::vector<SharedSpace> first;   // of these with the first grid's; none on that grid itself
};

struct Input {
  const Carving& hull;
  const ConsistencyOptions& options;
  SearchLimit limit;
  const Cells& cells;         // of the hull's grid
  std::span<const Cut> cuts;  // that of the options' grid first; none for arms that decide no cells
};

std::vector<RegionMap> regions_on(std::span<const CutDrawing> drawings, const VoxelGrid& hull) {
  std::vector<RegionMap> regions;
  for (const CutDrawing& drawing : drawings) regions.push_back(drawing.on(hull));
  return regions;
}

/// A hull on another grid; nothing where that is too coarse for any voxel.
std::optional<VoxelGrid> hull_on(int grid, const ViewSet& views) {
  try {
    return carve_silhouettes(views, {.grid = grid}).grid;
  } catch (const NoResult&) {
    return {};
  }
}

/// The grids on which cells are decided. What depends on how strokes fall on the voxels differs between them.
std::vector<int> grids(const ConsistencyOptions& options, int own) {
  const int grid = options.grid.value_or(own);
  if (!options.vote) return {grid};
  return {grid, std::max(1, grid * 3 / 4), std::min(kLargestGrid, grid * 9 / 8)};
}

std::vector<Cut> cut_hull(const VoxelGrid& hull, const Cells& own, std::span<const RegionMap> regions,
                          std::span<const CutDrawing> drawings, const ViewSet& views,
                          const ConsistencyOptions& options) {
  const int resolution = hull.size().maxCoeff();
  const std::vector<int> all = grids(options, resolution);
  std::vector<std::optional<Cut>> cuts(all.size());
  parallel_ranges(0, static_cast<int>(all.size()), 1, [&](int first, int last) {
    for (int k = first; k < last; ++k) {
      const std::optional<VoxelGrid> other = all[k] == resolution ? std::nullopt : hull_on(all[k], views);
      if (!other && all[k] != resolution && k > 0) continue;
      std::vector<RegionMap> cut =
          other ? regions_on(drawings, *other) : std::vector<RegionMap>(regions.begin(), regions.end());
      Cells cells = other ? partition(*other, cut) : own;
      cells.rays = trace(cells, cut);
      CellProblem problem(cells, cut, options.weights);
      std::vector<SharedSpace> of_own = shared_space(own, hull, cells, other ? *other : hull);
      cuts[k] = Cut{std::move(cut), std::move(cells), std::move(problem), other ? *other : hull, std::move(of_own), {}};
    }
  });
  std::vector<Cut> out;
  for (std::optional<Cut>& cut : cuts)
    if (cut) out.push_back(std::move(*cut));
  for (std::size_t k = 1; k < out.size(); ++k)
    out[k].first = shared_space(out[k].cells, out[k].grid, out[0].cells, out[0].grid);
  return out;
}

/// The cells' voxels, for those that are open.
std::vector<OpenCell> boxes_of(const Cells& cells, std::span<const std::uint8_t> open,
                               std::span<const std::uint8_t> keep) {
  std::vector<int> place(cells.count, -1);
  std::vector<OpenCell> out;
  for (int c = 0; c < cells.count; ++c) {
    if (!open[c]) continue;
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

/// What an arm left of the hull, and the choice it stands for.
struct Carved {
  ConsistencyResult result;
  std::optional<CellProblem> decision = {};  // that of the first grid
  std::vector<std::uint8_t> keep = {};       // per cell of the hull's grid
};

Carved as_printed(const Input& in) { return {{.grid = carve_as_printed(in.hull), .ran = Consistency::as_printed}}; }

/// What was decided on one grid.
struct Choice {
  CellProblem problem;
  Consistency ran;
  std::int64_t nodes;
  bool in_time = true;
};

std::vector<std::uint8_t> dropped(const CellProblem& problem) {
  std::vector<std::uint8_t> out;
  out.reserve(problem.cells());
  for (const std::uint8_t keep : problem.keep()) out.push_back(!keep);
  return out;
}

/// A problem where the other grids begin: what the first one dropped is dropped.
CellProblem begun(const Cut& cut, const Choice* first) {
  CellProblem problem = cut.hull;
  if (!first) return problem;
  const std::vector<std::uint8_t> there = mostly(cut.first, problem.cells(), dropped(first->problem));
  std::vector<int> drop;
  for (int c = 0; c < problem.cells(); ++c)
    if (there[c]) drop.push_back(c);
  problem.flip(drop);
  return problem;
}

/// Decides the cells on each grid, the first one first, and drops what most of the decisions drop.
template <class Decide>
Carved by_cells(const Input& in, Decide&& decide) {
  const int count = static_cast<int>(in.cuts.size());
  std::vector<std::optional<Choice>> choices(count);
  choices[0] = decide(in.cuts[0], nullptr);
  parallel_ranges(1, count, 1, [&](int first, int last) {
    for (int k = first; k < last; ++k) choices[k] = decide(in.cuts[k], &*choices[0]);
  });

  ConsistencyResult out{.ran = choices[0]->ran, .cells = choices[0]->problem.cells()};
  std::vector<int> votes(in.cells.count, 0);
  for (int k = 0; k < count; ++k) {
    out.nodes += choices[k]->nodes;
    out.in_time = out.in_time && choices[k]->in_time;
    const std::vector<std::uint8_t> drop = mostly(in.cuts[k].of_own, in.cells.count, dropped(choices[k]->problem));
    for (int c = 0; c < in.cells.count; ++c) votes[c] += drop[c];
  }
  std::vector<std::uint8_t> keep(in.cells.count);
  for (int c = 0; c < in.cells.count; ++c) keep[c] = 2 * votes[c] <= count;
  out.grid = assemble(in.hull.grid, in.cells, keep);
  return {std::move(out), std::move(choices[0]->problem), std::move(keep)};
}

/// Counts the solids that explain the drawings as well as the decision does.
void find_others(const Input& in, Carved& carved) {
  if (!carved.decision) return;
  const Alternatives others = find_alternatives(*carved.decision, in.options.alternatives);
  carved.result.solids = others.solids;
  carved.result.all_solids = others.all;
  std::vector<std::uint8_t> differs(carved.decision->cells(), 0);
  for (const int c : others.cells) differs[c] = 1;
  carved.result.open_cells = boxes_of(in.cells, mostly(in.cuts[0].of_own, in.cells.count, differs), carved.keep);
}

Choice in_one_pass(const Cut& cut, const Choice* first) {
  Choice choice{begun(cut, first), Consistency::two_level, 0};
  choice.nodes = first ? 0 : drop_in_one_pass(choice.problem, cut.cells);
  choice.nodes += flip_in_one_pass(choice.problem);
  return choice;
}

Carved two_level(const Input& in) {
  return by_cells(in, [](const Cut& cut, const Choice* first) {
    Choice choice = in_one_pass(cut, first);
    restore_unexplained(choice.problem);
    return choice;
  });
}

/// The search; where it was cut short before it looked at all cells, one pass if that ends lower.
Carved solver(const Input& in) {
  return by_cells(in, [&](const Cut& cut, const Choice* first) {
    constexpr int kShorter = 8;  // a search that begins where another ended
    Choice choice{begun(cut, first), Consistency::solver, 0};
    SearchLimit limit = in.limit;
    if (first) limit.nodes /= kShorter;
    const SearchEnd end = search_cells(choice.problem, cut.cells, limit);
    choice.nodes = end.nodes;
    choice.in_time = end.in_time;
    if (!end.looked_at_all && (!first || first->ran == Consistency::two_level)) {
      Choice pass = in_one_pass(cut, first);
      pass.nodes += choice.nodes;
      pass.in_time = choice.in_time;
      if (pass.problem.energy() < choice.problem.energy()) choice = std::move(pass);
    }
    restore_unexplained(choice.problem);
    return choice;
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
  const double longest = hull.grid.size().maxCoeff() * hull.grid.spacing();
  std::vector<std::optional<CutDrawing>> cut(views.views.size());
  parallel_ranges(0, static_cast<int>(cut.size()), 1, [&](int first, int last) {
    for (int v = first; v < last; ++v) cut[v].emplace(views.views[v], longest, options.regions);
  });
  std::vector<CutDrawing> drawings;
  drawings.reserve(cut.size());
  for (std::optional<CutDrawing>& drawing : cut) drawings.push_back(std::move(*drawing));
  const std::vector<RegionMap> regions = regions_on(drawings, hull.grid);
  std::vector<View> names;
  for (const AlignedView& view : views.views) names.push_back(view.view);
  ConsistencyResult result;
  result.grid = hull.grid;
  for (const RegionMap& map : regions) result.regions += map.count;
  result.hull_score = result.score = score_strokes(hull.grid, regions);
  monitor.at("consistency", 0.3);

  Cells cells;
  std::vector<Cut> cuts;
  if (options.arm != Consistency::as_printed) {
    cells = partition(hull.grid, regions);
    cuts = cut_hull(hull.grid, cells, regions, drawings, views, options);
  }
  Input in{hull, options, {options.nodes, {}}, cells, cuts};
  const auto start = std::chrono::steady_clock::now();
  if (options.seconds)
    in.limit.until = start + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                 std::chrono::duration<double>(*options.seconds));
  const auto checked = [&](Consistency arm) {
    Carved carved = kArms[static_cast<int>(arm)](in);
    VoxelGrid& grid = carved.result.grid;
    if (options.self_check) grid = cover_silhouettes(std::move(grid), hull.grid, names);
    carved.result.score = score_strokes(grid, regions);
    return carved;
  };
  const auto fits = [&](const Carved& carved) {
    return !options.self_check || carved.result.score.explains_more_than(result.hull_score);
  };
  Carved carved = checked(options.arm);
  if (!fits(carved) && carved.result.ran == Consistency::solver) {
    const ConsistencyResult rejected = std::move(carved.result);
    carved = checked(Consistency::two_level);
    carved.result.nodes += rejected.nodes;
    carved.result.in_time = rejected.in_time;
  }
  ConsistencyResult& out = carved.result;
  if (!fits(carved)) {
    out.ran = Consistency::none;
    out.score = result.hull_score;
    if (out.grid != hull.grid) {  // the decision is that of another solid
      out.grid = hull.grid;
      out.all_solids = false;
      carved.decision.reset();
    }
  }
  find_others(in, carved);
  std::vector<RegionBorders> borders;
  for (std::size_t v = 0; v < drawings.size(); ++v) borders.push_back(drawings[v].borders(regions[v], hull.grid));
  out.crossings = stroke_crossings(hull.grid, out.grid, borders);
  out.regions = result.regions;
  out.hull_score = result.hull_score;
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  monitor.at("consistency", 0.9);
  return std::move(carved.result);
}

}  // namespace carve
