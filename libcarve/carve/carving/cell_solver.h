#pragma once
#include "carve/carving/cell_problem.h"

namespace carve {

/// Drops, once and in the order of what it gains by itself, each cell whose absence lowers the energy: enough where
/// there are two levels of depth. \return choices looked at
std::int64_t drop_in_one_pass(CellProblem& problem);

/// Lowers the problem's energy from where it stands: descends over single cells and over the columns of cells behind
/// each region, anneals \cite kirkpatrick_1983, descends again. Looks at no more than `limit` choices; the same
/// everywhere. \return choices looked at
std::int64_t search_cells(CellProblem& problem, const Cells& cells, const Vec3i& size, std::span<const RegionMap> views,
                          std::int64_t limit);

}  // namespace carve
