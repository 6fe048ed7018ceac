#pragma once
#include "carve/core/raster.h"

namespace carve {

/// Euclidean distance of every pixel's centre to the centre of the nearest pixel that is not 0; infinity if there is
/// none. Linear in the number of pixels.
Raster<float> distance_transform(const Mask& mask);

}  // namespace carve
