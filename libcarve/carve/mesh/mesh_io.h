#pragma once
#include <filesystem>

#include "carve/mesh/mesh.h"

namespace carve {

struct WriteOptions {
  bool strict = true;  // refuse a mesh that is not closed, oriented and 2-manifold
};

/// Writes by the name's ending: .ply (binary little endian), .obj, .stl (binary, Z up as slicers expect), .glb
/// (glTF 2.0, Y up, with normals), .off. Whole or not at all; numbers in the C locale; the same mesh gives the same
/// bytes. \throws IoError; std::invalid_argument: unknown ending, or a mesh that is not solid under `strict`
void write_mesh(const std::filesystem::path& path, const Mesh& mesh, const WriteOptions& options = {});

/// Reads PLY (ascii, binary of either endianness), OBJ, STL (ascii, binary; equal corners merged), OFF, GLB; polygons
/// are fan-triangulated. STL is turned from Z up to Y up, as write_mesh turned it. \throws IoError: missing, truncated,
/// indices out of range, coordinates that are not finite, counts the file cannot hold
Mesh read_mesh(const std::filesystem::path& path);

}  // namespace carve
