#pragma once
#include "carve/core/vector.h"
#include "carve/surface/crossings.h"

namespace carve {

/// The outline's unit normal at each crossing of one coordinate plane, away from the object, as (first, second); (0, 0)
/// where there is no crossing or no telling. Laid out as PlaneCrossings.
struct PlaneNormals {
  using Normal = std::array<float, 2>;
  Raster<Normal> first, second;
};

/// The outline is the chain of its crossings, cell by cell. A crossing's tangent is taken across it where the outline
/// is smooth there, else from the side on which the outline is the straighter, as in essentially non-oscillatory
/// schemes \cite harten_1987: crossings beside a corner get the normal of their own side of it.
PlaneNormals contour_normals(const PlaneCrossings& crossings);

}  // namespace carve
