#pragma once
#include <string>

#include "report/table.h"

namespace carve::experiments {

/// Two results of one spec side by side, paired by run (model, method, swept values, seed), as Markdown: per metric and
/// method both means, the mean difference with its 95 % interval and sign test, whether that is beyond noise, and the
/// runs that moved most. Runs that only one side has, or that failed on one side, are counted and named.
std::string compare(const Overview& overview, const std::vector<Record>& a, const std::vector<Record>& b);

}  // namespace carve::experiments
