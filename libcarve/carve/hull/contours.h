#pragma once
#include <span>

#include "carve/hull/silhouette.h"
#include "carve/views/view_set.h"

namespace carve {

struct ContourOptions {
  double tolerance = 0;  // pixels
  bool subpixel = false;
};
template <class Visitor>
void visit_fields(ContourOptions& o, Visitor&& field) {
  field("tolerance", o.tolerance, 0.0, 100.0,
        "how far, in pixels, an exact hull's contours may leave the pixels' corners to save vertices; 0: not at all");
  field("subpixel", o.subpixel,
        "an exact hull's contours run within the pixels of soft borders instead of around them");
}

/// The borders of the views' pixels that are not background, as polygons on a common lattice.
///
/// Along an axis the lattice has a common multiple of the views' pixels where 2^16 allows, so pixel borders are exact;
/// else they are rounded to the nearest of 2^16. Either way the object's box is [0, n] in every view, so extents agree
/// exactly: the outermost pixels end with it. Opposite views become one silhouette, what both show. Pixels that only
/// meet in a corner are parted: both corners are cut off by one lattice unit (a quarter of a pixel or less). With a
/// tolerance vertices are left out (hull/simplify.h): at one pixel and above the staircases of slanted lines vanish.
///
/// With `subpixel` the outlines themselves, where soft borders put them: from cell to cell between the pixels' centres
/// (image/outline_loops.h), to the nearest lattice point. What is drawn hard loses half a pixel at its corners. Of
/// opposite views the lesser coverage counts, in the pixels of the first.
/// \throws std::invalid_argument on an option out of range
Silhouettes pixel_contours(const ViewSet& views, const ContourOptions& options = {});

}  // namespace carve
