#pragma once
#include <span>
#include <vector>

#include "carve/carving/carve_silhouettes.h"
#include "carve/carving/cell_problem.h"
#include "carve/carving/stroke_score.h"
#include "carve/core/monitor.h"

namespace carve {

/// Ways to carve what strokes show and silhouettes do not (thesis 3.1.2).
enum class Consistency {
  none,        // the hull
  as_printed,  // Algorithms 3.3 and 3.4 voxel by voxel, in the reading of papers/notes/silva_2018.md
  two_level,   // cells, one pass: what the thesis claims to do
  solver       // cells, several depth levels: the thesis's future work (5.2)
};
inline std::span<const char* const> names(Consistency) {
  static constexpr const char* all[] = {"none", "as_printed", "two_level", "solver"};
  return all;
}

struct ConsistencyOptions {
  Consistency arm = Consistency::solver;
  RegionOptions regions = {};
  CellWeights weights = {};
  int nodes = 80000;
  bool self_check = true;
};
template <class Visitor>
void visit_fields(ConsistencyOptions& o, Visitor&& field) {
  field("arm", o.arm, "how concave parts are carved");
  visit_fields(o.regions, field);
  visit_fields(o.weights, field);
  field("nodes", o.nodes, 0, 100000000, "most choices the solver looks at before it takes the best so far");
  field("self_check", o.self_check, "keep the hull's silhouettes, and the hull where it explains the strokes better");
}

struct ConsistencyResult {
  VoxelGrid grid = {};
  Consistency ran = Consistency::none;  // none: nothing explained the drawings better than the hull
  int regions = 0, cells = 0;
  std::int64_t nodes = 0;
  StrokeScore hull_score = {}, score = {};  // not measured by `none`
};

/// Drops parts of the hull so that depth jumps lie where strokes are drawn. The result lies inside the hull, keeps its
/// silhouettes, and explains the drawings at least as well (score); else it is the hull. \cite silva_2018
/// \throws std::invalid_argument on an option out of range
ConsistencyResult apply_consistency(const Carving& hull, const ViewSet& views, const ConsistencyOptions& options = {},
                                    const Monitor& monitor = {});

}  // namespace carve
