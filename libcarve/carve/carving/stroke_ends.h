#pragma once
#include <vector>

#include "carve/core/raster.h"
#include "carve/core/vector.h"

namespace carve {

/// Where a stroke ends inside the surface.
struct StrokeEnd {
  int x, y;     // its last pixel
  Vec2 onward;  // unit direction in which it would go on; x to the right, y down
};

/// \param width  stroke_width(). Ends nearer to the background than about two widths are none.
std::vector<StrokeEnd> stroke_ends(const Raster<Label>& label, double width);

/// Cuts components of the surface where a stroke that ends would have parted them: along the shortest straight way from
/// its end to another stroke or the background, turning by at most 60 degrees. Ways of at most `gap` pixels to another
/// end are gaps in a stroke; they and those of more than `longest` are not cut. \param component  as
/// stroke_components() \return the parts, named as components are
Raster<int> cut_at_ends(const Raster<Label>& label, const Raster<int>& component, double width, double gap,
                        double longest);

}  // namespace carve
