#pragma once
#include <chrono>
#include <optional>

#include "carve/carving/cell_problem.h"

namespace carve {

/// When a search ends with the best it has. Without a time limit it is the same everywhere.
struct SearchLimit {
  std::int64_t nodes = 0;  // choices looked at
  std::optional<std::chrono::steady_clock::time_point> until = {};
};

struct SearchEnd {
  std::int64_t nodes = 0;
  bool in_time = true;        // the clock did not end it
  bool looked_at_all = true;  // at each column and cell at least
};

/// Drops each cell, alone or with all that hides it in two views, where that lowers the energy: once, and in the order
/// of what it gains by itself. \return choices looked at
std::int64_t drop_in_one_pass(CellProblem& problem, const Cells& cells);

/// Drops and restores single cells likewise. \return choices looked at
std::int64_t flip_in_one_pass(CellProblem& problem);

/// Restores each connected part of what is dropped, with its mirror image, that adds more than one depth jump elsewhere
/// for four strokes that it explains: the rule by which a whole solid is accepted (StrokeScore::explains_more_than).
void restore_unexplained(CellProblem& problem);

/// Lowers the problem's energy from where it stands: descends over the columns of cells behind each region, single
/// cells and cells with all that hides them in two views; anneals \cite kirkpatrick_1983 if what is left of the limit
/// is enough for that, else starts again from drop_in_one_pass() if half of it is left; after either descends again.
SearchEnd search_cells(CellProblem& problem, const Cells& cells, const SearchLimit& limit);

}  // namespace carve
