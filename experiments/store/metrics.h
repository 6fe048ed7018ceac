#pragma once
#include <span>
#include <string>

namespace carve::experiments {

enum class Better { lower, higher, neither };

/// A column of a table: one line here gives its legend, its best entry and its plot's axis.
struct RunMetric {
  std::string name, formula, unit;
  Better better;
};

/// Evaluation's metrics (eval/metrics.h) and what a run measures of itself: seconds, seconds_<stage>, megabytes,
/// triangles.
std::span<const RunMetric> metrics();
const RunMetric* find_metric(const std::string& name);  // null if there is none

}  // namespace carve::experiments
