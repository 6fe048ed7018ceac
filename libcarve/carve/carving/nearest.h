#pragma once
#include "carve/core/raster.h"

namespace carve {

/// Index (y * width + x) of the nearest pixel that is set, per pixel, by two sweeps of vector propagation
/// \cite danielsson_1980; -1 everywhere if none is set. Off by a fraction of a pixel at worst.
Raster<int> nearest_set(const Mask& mask);

/// Euclidean distance in pixels to those.
Raster<float> distance_to(const Raster<int>& nearest);

}  // namespace carve
