#pragma once
#include <filesystem>
#include <vector>

#include "carve/mesh/textured_mesh.h"

namespace carve {

struct WriteOptions {
  bool strict = true;  // refuse a mesh that is not closed, oriented and 2-manifold
};

/// Writes by the name's ending: .ply (binary little endian), .obj, .off, .stl (binary, Z up as slicers expect), .glb
/// (glTF 2.0, Y up, with normals). PLY, OBJ and OFF keep every bit of the coordinates; STL and GLB hold floats. Whole
/// or not at all; numbers in the C locale; the same mesh gives the same bytes. \throws IoError if the file cannot be
/// written; std::invalid_argument: unknown ending, an index or coordinate that
///         check_mesh refuses or the format cannot hold, or (strict) a mesh that is not solid, saying what is wrong
void write_mesh(const std::filesystem::path& path, const Mesh& mesh, const WriteOptions& options = {});

/// write_mesh, with the texture where the format holds one and there is one: .glb with the PNG inside; .obj with a
/// material file and a PNG beside it, named like it (the mesh is written last). sRGB, as the formats have it. \throws
/// also std::invalid_argument: texture coordinates that are not finite or do not fit the triangles
void write_textured_mesh(const std::filesystem::path& path, const TexturedMesh& textured,
                         const WriteOptions& options = {});
/// By the name's ending: .glb and .obj.
bool holds_texture(const std::filesystem::path& path);
/// The files that are written beside `path` if there is a texture: for OBJ the picture and the material.
std::vector<std::filesystem::path> texture_files(const std::filesystem::path& path);

/// Reads PLY (ascii, binary of either endianness), OBJ, STL (ascii, binary; equal corners merged), OFF and GLB (every
/// mesh of the scene where its nodes put it; in those with texture coordinates, which GLB splits along seams, vertices
/// at equal positions are merged); polygons are fan-triangulated, what is not geometry is skipped. STL is turned from Z
/// up to Y up, as write_mesh turned it. Needs memory for the file and the mesh, whatever the file says. \throws IoError
/// naming the place: missing, truncated, indices out of range, coordinates that are not finite, counts
///         the file cannot hold
Mesh read_mesh(const std::filesystem::path& path);
/// A .glb file whose triangles all take their base colour from one picture inside it. \throws IoError also for others
TexturedMesh read_textured_mesh(const std::filesystem::path& path);

}  // namespace carve
