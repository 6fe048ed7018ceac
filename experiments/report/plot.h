#pragma once
#include <filesystem>
#include <string>

#include "report/table.h"

namespace carve::experiments {

/// Draws a table with gnuplot: over the first swept field if there is one, a line a method (mean over the models that
/// every method has), else a group of bars a model, dots for more of them, and for very many the spread of their
/// differences from the baseline, a box a method (half of the models; whiskers 1.5 times as long). Leaves NAME.csv,
/// NAME.gnuplot and NAME.svg, .pdf, .png in the folder; the script redraws the figures from the CSV alone; nothing if
/// no run has the metric. \throws NoResult if gnuplot is missing or fails
void plot(const std::filesystem::path& folder, const std::string& name, const Overview& overview,
          const std::vector<Record>& records, const RunMetric& metric);

}  // namespace carve::experiments
