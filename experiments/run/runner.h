#pragma once
#include <functional>
#include <optional>

#include "run/plan.h"

namespace carve::experiments {

struct RunnerOptions {
  int jobs = 1;
  bool force = false;                      // do finished runs again
  bool fail_fast = false;                  // start nothing more after the first failure
  double seconds = 300, megabytes = 6000;  // of one run
};

struct Progress {
  int total = 0, done = 0, skipped = 0, failed = 0, running = 0;
  int absent = 0;           // their programs are not installed
  double seconds_left = 0;  // estimated from the runs done so far
  std::string last;         // path and outcome of the run that just ended
};

/// Runs every cell that is not finished, each in a process of its own (this program's `cell` command) under the limits:
/// a crash, a hang or too much memory costs that cell, whose record says why. Records are written whole; killing this
/// process kills its runs, and the next call does only what is missing.
/// \return progress at the end; failed > 0 if any cell has no result
Progress run_all(const std::filesystem::path& results, const std::string& spec, const std::vector<Cell>& cells,
                 const RunnerOptions& options, const std::function<void(const Progress&)>& tell);

/// The record in a cell's folder, if it is of this very run (same id) and has a result.
std::optional<Record> finished(const std::filesystem::path& results, const Cell& cell);
/// The run said that a program it needs is not installed (run/external.h).
bool left_out(const std::filesystem::path& results, const Cell& cell);
void store_record(const std::filesystem::path& results, const Cell& cell, const Record& record);
/// A record with a cell's parameters, of this program here and now, and nothing measured yet.
Record record_of(const std::string& spec, const Cell& cell, const std::string& status);

/// A cell as the argument its process is given, and back.
std::string cell_argument(const std::string& spec, const Cell& cell);
std::pair<std::string, Cell> cell_from_argument(const std::string& argument);

}  // namespace carve::experiments
