#pragma once
#include <optional>
#include <vector>

#include "carve/core/raster.h"

namespace carve {

/// Finds a place for each shape on a square of `side` cells, so that no cell is taken twice: tall ones first, each at
/// the first place, row by row, where it fits into what is left. Nothing if one does not fit.
/// \param shapes  1 where the shape covers a cell; not rotated
struct Place {
  int x = 0, y = 0;
};
std::optional<std::vector<Place>> pack(const std::vector<Mask>& shapes, int side);

}  // namespace carve
