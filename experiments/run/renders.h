#pragma once
#include <filesystem>
#include <vector>

#include "store/record.h"

namespace carve::experiments {

/// Draws, for every model a spec wants renders of and every combination of swept values, the drawings and below them
/// each method's mesh, textured if it has one, from the front, from behind and from below (as Fig. 4.11 to 4.20):
/// FOLDER/renders/MODEL[,FIELD=VALUE].png. \return the pictures written; a method without a result is left out
std::vector<std::filesystem::path> draw_renders_of(const std::filesystem::path& folder, const Overview& overview,
                                                   const std::vector<Record>& records);

}  // namespace carve::experiments
