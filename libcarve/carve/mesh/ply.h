#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "carve/mesh/mesh_io.h"

namespace carve {

/// One value a vertex beside its position: "quality" (MeshLab) or "scalar_C2M" (CloudCompare) as floats, "red",
/// "green", "blue" as bytes.
struct VertexProperty {
  std::string name;                                                    // letters, digits and underscores; not x, y or z
  std::variant<std::vector<float>, std::vector<std::uint8_t>> values;  // #V
};

/// As write_mesh to a .ply, with these values at its vertices. A mesh without triangles is a point cloud, which needs
/// `strict` off. \throws as write_mesh; std::invalid_argument: a property whose name or number of values does not fit
void write_ply(const std::filesystem::path& path, const Mesh& mesh, std::span<const VertexProperty> properties,
               const WriteOptions& options = {});

}  // namespace carve
