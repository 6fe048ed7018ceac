#pragma once
#include "carve/core/raster.h"

namespace carve {

inline bool black(const Rgba& p) { return p.a >= 128 && p.r < 32 && p.g < 32 && p.b < 32; }

inline int count_black(const Picture& picture, Box box) {
  int count = 0;
  for (int y = box.y0; y < box.y1; ++y)
    for (int x = box.x0; x < box.x1; ++x) count += black(picture(x, y));
  return count;
}
inline int count_black(const Picture& picture) { return count_black(picture, {0, 0, picture.width, picture.height}); }

/// Of the pixels that are at least half covered.
inline Box covered_box(const Picture& picture) {
  Box box{picture.width, picture.height, 0, 0};
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      if (picture(x, y).a >= 128) {
        box.x0 = std::min(box.x0, x), box.x1 = std::max(box.x1, x + 1);
        box.y0 = std::min(box.y0, y), box.y1 = std::max(box.y1, y + 1);
      }
  return box;
}

}  // namespace carve
