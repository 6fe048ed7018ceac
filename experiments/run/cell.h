#pragma once
#include "run/plan.h"

namespace carve::experiments {

/// Does one run in this process: drawings from the model, the method, the measures; leaves mesh.ply, drawings and
/// run.json in the cell's folder. Threads never change what it finds, only how long it takes. \throws whatever the
/// method throws: nothing is recorded then
void run_cell(const std::filesystem::path& results, const std::string& spec, const Cell& cell, int threads);

}  // namespace carve::experiments
