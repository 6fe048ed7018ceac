#pragma once
#include <algorithm>
#include <iterator>

#include "carve/core/raster.h"

namespace carve {

/// The pixels for whose values is_inside holds; empty() if there are none.
template <class T, class Test>
Box bounds(const Raster<T>& raster, Test&& is_inside) {
  Box box{raster.width, raster.height, 0, 0};
  for (int y = 0; y < raster.height; ++y) {
    const T* row = &raster(0, y);
    const T* end = row + raster.width;
    const T* first = std::find_if(row, end, is_inside);
    if (first == end) continue;
    const auto last = std::find_if(std::make_reverse_iterator(end), std::make_reverse_iterator(first), is_inside);
    box.x0 = std::min(box.x0, static_cast<int>(first - row));
    box.x1 = std::max(box.x1, static_cast<int>(last.base() - row));
    box.y0 = std::min(box.y0, y);
    box.y1 = y + 1;
  }
  return box;
}

}  // namespace carve
