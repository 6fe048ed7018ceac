#pragma once
#include "carve/core/raster.h"

namespace carve {

/// Splits components further where the colour or texture changes \cite felzenszwalb_2004; neighbouring segments of one
/// component whose mean colours hardly differ are one. Only pixels that `clean` says are free of anti-aliasing take
/// part; the others are -1. A segment is named by its first pixel. \param voxel  pixels that a voxel covers: segments
/// much smaller do not count
Raster<int> colour_segments(const Raster<int>& component, const Raster<Rgba>& colour, const Mask& clean, double voxel);

}  // namespace carve
