#pragma once
#include <optional>
#include <span>
#include <vector>

#include "carve/carving/carve_silhouettes.h"
#include "carve/carving/cell_problem.h"
#include "carve/carving/stroke_score.h"
#include "carve/core/monitor.h"
#include "carve/grid/edge_crossings.h"

namespace carve {

/// Ways to carve what strokes show and silhouettes do not (thesis 3.1.2).
enum class Consistency {
  none,        // the hull
  as_printed,  // Algorithms 3.3 and 3.4 voxel by voxel, in the reading of papers/notes/silva_2018.md
  two_level,   // cells, one pass: what the thesis claims to do
  solver       // cells, several depth levels: the thesis's future work (5.2); two_level where that explains more
};
inline std::span<const char* const> names(Consistency) {
  static constexpr const char* all[] = {"none", "as_printed", "two_level", "solver"};
  return all;
}

struct ConsistencyOptions {
  Consistency arm = Consistency::solver;
  std::optional<int> grid = 128;
  bool vote = true;
  RegionOptions regions = {};
  CellWeights weights = {};
  int nodes = 150000;
  std::optional<double> seconds = {};
  int alternatives = 2000;
  bool self_check = true;
};
template <class Visitor>
void visit_fields(ConsistencyOptions& o, Visitor&& field) {
  field("arm", o.arm, "how concave parts are carved");
  field("grid", o.grid, 8, kLargestGrid,
        "voxels along the longest side of the grid on which cells are decided; auto: those of the carving");
  field("vote", o.vote, "decide on three quarters and nine eighths of that grid too, drop what two of the three drop");
  visit_fields(o.regions, field);
  visit_fields(o.weights, field);
  field("nodes", o.nodes, 0, 100000000,
        "most choices the solver looks at before it takes the best so far, those that many rays see counting for "
        "several; the vote's other two grids get an eighth each");
  field("seconds", o.seconds, 0.0, 1e6,
        "the same in seconds; auto: no such limit. With one, results depend on the machine");
  field("alternatives", o.alternatives, 0, 100000000,
        "most choices looked at for other solids that explain the drawings as well");
  field("self_check", o.self_check, "keep the hull's silhouettes, and the hull where it explains the strokes better");
}

/// A cell that the drawings leave open: it is kept in one of the solids that explain them equally well, dropped in
/// another.
struct OpenCell {
  std::int64_t voxels = 0;
  bool kept = false;  // in the solid that was chosen
  Vec3i low, high;    // its box in voxels: low <= index < high
  std::vector<CellRun> runs = {};
};

struct ConsistencyResult {
  VoxelGrid grid = {};
  AxisCrossings crossings = {};         // of the surface that was carved into the hull (stroke_crossings)
  Consistency ran = Consistency::none;  // none: nothing explained the drawings better than the hull
  int regions = 0, cells = 0;
  std::int64_t nodes = 0;
  double seconds = 0;                       // of the arm and what it fell back to
  bool in_time = true;                      // no limit in seconds ended the search
  std::int64_t solids = 1;                  // that explain the drawings equally well, with the one chosen
  bool all_solids = true;                   // there are no more that changing one cell at a time leads to
  std::vector<OpenCell> open_cells = {};    // in which they differ
  StrokeScore hull_score = {}, score = {};  // not measured by `none`
};

/// Drops parts of the hull so that depth jumps lie where strokes are drawn. The result lies inside the hull, keeps its
/// silhouettes, and explains the drawings at least as well (score); else it is the hull. \cite silva_2018
/// \throws std::invalid_argument on an option out of range
ConsistencyResult apply_consistency(const Carving& hull, const ViewSet& views, const ConsistencyOptions& options = {},
                                    const Monitor& monitor = {});

}  // namespace carve
