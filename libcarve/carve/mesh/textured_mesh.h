#pragma once
#include <vector>

#include "carve/core/raster.h"
#include "carve/mesh/mesh.h"

namespace carve {

/// A mesh and the picture that lies on it. Corner k of triangle t is at uvs[uv_triangles[t][k]]; along seams a vertex
/// has several. (0, 0) is the texture's top left corner and (1, 1) its bottom right one (glTF's; OBJ turns v over).
/// The texture is sRGB, opaque, and may be empty: then there are no coordinates either.
struct TexturedMesh {
  Mesh mesh;
  std::vector<Vec2> uvs;
  std::vector<Triangle> uv_triangles;  // as many as the mesh has triangles, or none
  Picture texture;
};

}  // namespace carve
