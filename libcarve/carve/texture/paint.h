#pragma once
#include <vector>

#include "carve/mesh/mesh.h"
#include "carve/texture/choose_views.h"
#include "carve/texture/drawings.h"

namespace carve {

/// The one drawing each triangle was given.
std::vector<Paint> paint_by_view(const ViewChoice& choice);

/// Equation 3.10 \cite silva_2018: weights are the clamped cosines between the triangle's normal and the directions to
/// the drawings' viewers, normalised. With the mirror, the side's drawing serves triangles that look left too.
std::vector<Paint> paint_by_normal(const Mesh& mesh, const ViewSet& views, Mirror mirror);

}  // namespace carve
