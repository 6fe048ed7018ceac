#pragma once
#include "carve/core/monitor.h"
#include "carve/mesh/textured_mesh.h"
#include "carve/texture/atlas.h"

namespace carve {

/// A mesh with the drawings' colours on it (thesis 3.2), in the drawings' object units.
///
/// Arms: where texels come from (`texture.arm`) and how the surface is cut into charts (`atlas.arm`). Memory beside
/// mesh and drawings: 9 bytes a texel, 4 of them the result's; 600 MB at 8192 x 8192. The same bytes whatever the
/// thread count. \throws std::invalid_argument: an option out of range, arm none or auto, a mesh without triangles or
/// that check_mesh refuses; NoResult if the charts do not fit
TexturedMesh texture(Mesh mesh, const ViewSet& views, const TextureOptions& options, const AtlasOptions& atlas = {},
                     const Monitor& monitor = {});

}  // namespace carve
