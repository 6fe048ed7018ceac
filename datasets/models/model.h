#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "carve/core/raster.h"
#include "carve/mesh/mesh.h"

namespace carve {

struct Material {
  std::string name;
  Rgba colour;
  Picture texture = {};  // empty: the flat colour; else it replaces the colour
};

/// A coloured base model: what drawings are synthesized from and reconstructions are measured against. One or several
/// shells, which may interpenetrate; procedural models' shells are closed, artists' need not be.
struct Model {
  Mesh mesh;
  std::vector<int> material = {};  // per triangle, index of materials
  std::vector<Vec2> uv = {};       // 3 per triangle, v = 0 at the texture's lower edge, repeating; or empty
  std::vector<Material> materials = {};
};

/// Low and high corner of the box of all positions. \throws std::invalid_argument if there are none
std::pair<Vec3, Vec3> bounds(const Mesh& mesh);

/// In object units: longest side 1, centred on x and z, standing on y = 0 (as reconstructions are).
/// \throws std::invalid_argument if the mesh is empty or a point
Model placed(Model model);

/// Reads OBJ with its MTL (Kd, map_Kd; PNG, JPEG, TIFF or WebP) as it stands; polygons are fan-triangulated, faces
/// without a material get a grey one. \throws IoError "path:line: why"
Model load_model(const std::filesystem::path& path);

/// Writes folder/model.obj, folder/model.mtl and a PNG a texture. Coordinates read back to the same doubles.
/// \throws IoError
void write_model(const std::filesystem::path& folder, const Model& model);

}  // namespace carve
