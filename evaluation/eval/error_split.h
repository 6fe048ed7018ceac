#pragma once
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include "eval/metrics.h"

namespace carve {

/// A surface on the way from the drawings to the result: the exact hull, the unsmoothed voxels' surface, the result.
struct Stage {
  std::string name;  // of what it adds: "hull limit", "discretisation", "smoothing"
  Mesh mesh;
};

/// What a stage adds to the error: its metric less that of the stage before; the first stage's is its metric itself. So
/// the contributions add up to the last stage's metric; one that repairs something is negative.
struct Contribution {
  std::string name;
  double value = 0, percent = 0;  // model's unit, % of the reference's diagonal
  double moved_mean = 0;          // two-way mean distance (chamfer_l1) to the stage before; 0 for the first
  double moved_max = 0;           // two-way sampled maximum (hausdorff)
};

/// \param metric  a length of eval/metrics.h without a tolerance, lower = better
/// \throws std::invalid_argument: another metric, no stage, a mesh without area
std::vector<Contribution> split_error(const Reference& reference, std::span<const Stage> stages,
                                      const std::string& metric = "chamfer_l1");
std::ostream& operator<<(std::ostream& out, const std::vector<Contribution>& split);  // a line a stage and their sum

}  // namespace carve
