#pragma once
#include <filesystem>
#include <vector>

#include "store/record.h"

namespace carve::experiments {

/// Draws, for every model a spec wants heat maps of and every combination of swept values, the methods' meshes side by
/// side on one scale beside the reference (as Fig. 4.2, 4.3, 4.6): FOLDER/heat_maps/MODEL[,FIELD=VALUE].png.
/// \return the pictures written; a method without a result is left out
std::vector<std::filesystem::path> draw_heat_maps_of(const std::filesystem::path& folder, const Overview& overview,
                                                     const std::vector<Record>& records);

}  // namespace carve::experiments
