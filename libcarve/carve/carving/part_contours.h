#pragma once
#include <vector>

#include "carve/carving/convex_refinement.h"
#include "carve/carving/sections.h"

namespace carve {

inline constexpr int kRectangle = 0;  // instead of an exponent

/// The share of its box that the superellipse |u|^exponent + |v|^exponent = 1 fills.
double superellipse_fill(double exponent);

/// The exponent of each part's contour, at least 2; kRectangle where the drawings do not show that it is round.
/// \param longest  voxels along the solid's longest side
std::vector<int> part_exponents(const Sections& all, int longest, const ConvexOptions& options);

}  // namespace carve
