#pragma once
#include <vector>

#include "store/record.h"

namespace carve::experiments {

/// Every column a table may have: evaluation's metrics (eval/metrics.h; lengths in % of the reference's diagonal), what
/// is known without ground truth, and what a run measures of itself.
const std::vector<RunMetric>& metrics();
const RunMetric* find_metric(const std::string& name);  // null if there is none

}  // namespace carve::experiments
