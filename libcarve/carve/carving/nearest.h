#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "carve/core/raster.h"

namespace carve {

/// Which pixel of a mask that is set lies nearest: prepared in two scans of the rows, then asked for single pixels. An
/// answer looks at the rows in reach only, so asking is cheap where one is near.
class NearestSet {
 public:
  explicit NearestSet(const Mask& mask);

  /// Index (y * width + x) of the nearest one within `limit` pixels of pixel (x, y), -1 if there is none. Of several as
  /// near: the one on the left, else one above, else the one on the right.
  int operator()(int x, int y, double limit = std::numeric_limits<double>::infinity()) const;
  /// Euclidean distance to it in pixels; infinite if there is none within `limit`.
  double distance(int x, int y, double limit = std::numeric_limits<double>::infinity()) const;

 private:
  int width_, height_;
  std::vector<std::int16_t> column_;  // of the nearest one in the pixel's row; -1: none
};

/// Squared Euclidean distance of every pixel to the nearest one that is set, at most limit * limit.
/// Work grows with limit. \param limit  pixels, in [1, 181], so that two squares fit 16 bits
Raster<std::uint16_t> squared_distances(const Mask& mask, int limit);

}  // namespace carve
