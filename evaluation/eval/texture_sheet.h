#pragma once
#include "carve/mesh/textured_mesh.h"

namespace carve {

/// The model from four sides, a quarter turn apart and from somewhat above (the first shows front and side), all at one
/// scale, and its texture: five pictures of `size` pixels side by side on white.
Picture texture_sheet(const TexturedMesh& model, int size);

}  // namespace carve
