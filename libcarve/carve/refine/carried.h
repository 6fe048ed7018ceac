#pragma once
#include "carve/mesh/mesh.h"

namespace carve::refining {

/// The mesh moved as a coarse copy of it moved, from `coarse` to `bent`: each vertex by the weighted mean of the coarse
/// vertices within `reach` that face its way; those without any stay.
Mesh carried(const Mesh& mesh, const Mesh& coarse, const Mesh& bent, double reach);

}  // namespace carve::refining
