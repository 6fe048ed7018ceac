#pragma once
// Internal to carve/texture.
#include "carve/texture/atlas.h"

namespace carve {

/// Lays each chart that is a disk out by a least squares conformal map \cite levy_2002, scaled to the least distortion
/// and turned to how it lies, if that lays no triangle face down and has the lower symmetric Dirichlet energy; others
/// stay as they are. \param density  coordinates a model unit \return per chart, its mean energy at that density (4 =
/// isometric); infinite if a triangle lies face down
std::vector<double> unfold(const Mesh& mesh, double density, Charts& charts);

}  // namespace carve
