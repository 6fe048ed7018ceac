#pragma once
#include <span>
#include <vector>

#include "carve/hull/facets.h"

namespace carve::hull {

/// Gives each side its partner, the same side of the neighbouring facet; sides are split where others end on them.
/// \throws std::logic_error if the sides do not bound a solid
std::vector<FacetSide> match_sides(const std::vector<ExactPoint>& points, std::span<const FacetPlane> planes,
                                   std::vector<FacetSide> sides);

}  // namespace carve::hull
