#pragma once
#include "carve/texture/atlas.h"
#include "carve/texture/surface_colours.h"

namespace carve {

/// Colours every texel that a triangle owns from the place on the surface it stands for (Equation 3.8): what the
/// triangle's paint shows there, averaged over the texel, and what its corners add. Equation 3.9's homography between a
/// drawing and a triangle is affine for parallel projections, so it is the triangle's own map. Texels within `gutter`
/// of a chart repeat its nearest colour; the others have the mean of all.
Picture bake(const Mesh& mesh, const Atlas& atlas, const std::vector<Paint>& paints, const Drawings& drawings,
             const CornerColours& corners, int gutter);

}  // namespace carve
