#pragma once
#include "carve/carving/cell_problem.h"

namespace carve {

/// Other choices of cells that explain the drawings as well: strokes and silhouettes cost no more, and only what is
/// asked of solids in general (area, volume) tells them from the choice made.
struct Alternatives {
  std::int64_t solids = 1;  // with the choice made; found by changing one cell after the other
  bool all = true;          // there are no more that can be reached so
  std::vector<int> cells;   // which are kept in one of them and dropped in another; ascending
};

/// Looks at no more than `limit` choices besides each cell's own. The problem is left as it was.
Alternatives find_alternatives(CellProblem& problem, std::int64_t limit);

}  // namespace carve
