#pragma once
#include <array>
#include <vector>

#include "carve/mesh/mesh.h"
#include "carve/texture/paint.h"

namespace carve {

/// Colours at triangles' corners, added to what the drawings give and linear in between.
struct CornerColours {
  std::vector<Colour> colours;
  std::vector<std::array<int, 3>> corners;  // per triangle; -1 = nothing is added
};

/// What is added where no drawing shows the surface and along seams between drawings:
/// - triangles without paint take their whole colour from it: that of the nearest paint along the surface, heights
///   counting six times, as things change with height rather than around; evened out among colours that differ little,
///   so that borders between flat colours stay sharp. A part without any paint takes the drawings' mean;
/// - at a vertex where patches meet whose colours differ by at most `level` (RGB distance), both sides are moved to
///   meet, fading out within some triangles \cite lempitsky_2007; larger differences are the drawing's own.
/// \param patch  per triangle; triangles of one patch with paint have the same drawings
CornerColours surface_colours(const Mesh& mesh, const std::vector<Paint>& paints, const std::vector<int>& patch,
                              const Drawings& drawings, double level);

}  // namespace carve
