#pragma once
#include <span>

#include "carve/hull/silhouette.h"
#include "carve/views/view_set.h"

namespace carve {

/// The borders of the views' pixels that are not background, as polygons on a common lattice.
///
/// Along an axis the lattice has a common multiple of the views' pixels where 2^16 allows, so pixel borders are exact;
/// else they are rounded to the nearest of 2^16. Either way the object's box is [0, n] in every view, so extents agree
/// exactly. Opposite views become one silhouette, what both show. Pixels that only meet in a corner are parted: both
/// corners are cut off by one lattice unit (a quarter of a pixel or less).
Silhouettes pixel_contours(const ViewSet& views);

}  // namespace carve
