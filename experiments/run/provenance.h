#pragma once
#include <map>
#include <string>

namespace carve::experiments {

/// Commit of the source tree and whether it has changes, asked of git once and handed to the runs by the environment.
void export_commit();

/// Where a run's figures come from: commit, dirty, program, compiler, flags, libraries, cpu, cores, load
/// (mean of the last minute), date (UTC).
std::map<std::string, std::string> provenance();

}  // namespace carve::experiments
