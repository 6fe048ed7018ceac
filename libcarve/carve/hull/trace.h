#pragma once
#include <span>

#include "carve/core/raster.h"
#include "carve/hull/silhouette.h"

namespace carve::hull {

/// The borders of a mask's pixels as loops with the inside on the left; pixel (i, j) covers columns[i] to
/// columns[i + 1] and rows[j] to rows[j + 1], both ascending by 4 or more. Pixels that only meet in a corner are
/// parted: both corners are cut off by one lattice unit.
std::vector<LatticeLoop> trace(const Mask& mask, std::span<const std::int32_t> columns,
                               std::span<const std::int32_t> rows);

}  // namespace carve::hull
