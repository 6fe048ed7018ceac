#pragma once
#include "carve/carving/cell_problem.h"

namespace carve {

struct CellSearch {
  std::int64_t nodes = 0;  // moves tried
  bool finished = true;    // false: the bound on nodes was met first
};

/// Drops, once and in the order of what it gains by itself, each cell whose absence lowers the energy: enough where
/// there are two levels of depth. \return choices looked at
std::int64_t drop_in_one_pass(CellProblem& problem);

/// Lowers the problem's energy from where it stands.
CellSearch descend(CellProblem& problem, const Cells& cells, const Vec3i& size, std::span<const RegionMap> views,
                   std::int64_t node_limit);

}  // namespace carve
