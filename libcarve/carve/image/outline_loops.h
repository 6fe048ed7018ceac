#pragma once
#include <vector>

#include "carve/core/raster.h"
#include "carve/core/vector.h"

namespace carve {

/// Where an outline crosses the lattice of pixel centres: between the centres of pixels (x, y) and (x + 1, y), or
/// (x, y + 1) below.
struct OutlineCrossing {
  int x, y;
  bool along_row;
  Vec2 place;  // column and row, on the line between the two centres, as the outline (image/outline.h) has it
};

/// The borders of a coverage (0..255 as in Drawing) of one half and more: closed loops of crossings from cell to cell
/// of the lattice, the object on the left as the picture is seen. Parts that meet in a corner are parted.
std::vector<std::vector<OutlineCrossing>> outline_loops(const Mask& coverage);

}  // namespace carve
