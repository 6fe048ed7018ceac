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
  bool in_time = true;  // the clock did not end it
};

/// Drops, once and in the order of what it gains by itself, each cell whose absence lowers the energy: enough where
/// there are two levels of depth. \return choices looked at
std::int64_t drop_in_one_pass(CellProblem& problem);

/// Restores each connected part of what is dropped, with its mirror image, that adds more than one depth jump elsewhere
/// for four strokes that it explains: the rule by which a whole solid is accepted (StrokeScore::explains_more_than).
void restore_unexplained(CellProblem& problem);

/// Lowers the problem's energy from where it stands: descends over single cells and over the columns of cells behind
/// each region, anneals \cite kirkpatrick_1983, descends again.
SearchEnd search_cells(CellProblem& problem, const Cells& cells, const SearchLimit& limit);

}  // namespace carve
