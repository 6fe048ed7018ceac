#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "artist/model.h"
#include "carve/core/raster.h"

namespace carve::artist {

// Every reader keeps the source's axes and unit and throws IoError on a file that is missing, truncated, of another
// format, or whose counts, indices or numbers cannot be. `name` is what errors call the bytes.

/// Wavefront OBJ with the MTL files beside it. Polygons are cut into triangles of their own plane. \param objects
/// names of `o` or `g` statements whose faces are taken; empty: all
Model read_obj(const std::filesystem::path& path, std::span<const std::string> objects = {});

/// 3DS, AC3D, glTF, OFF, PLY and BLEND (by the name's ending; .gz is unpacked), through libassimp: the whole scene,
/// with its nodes' transformations. \param objects names of the nodes whose meshes are taken; empty: all
Model read_assimp(const std::filesystem::path& path, std::span<const std::string> objects = {});

/// Open Inventor, binary or text, through libCoin: every shape as triangles, one material a colour.
Model read_inventor(const std::filesystem::path& path);

/// Quake 2 (MD2, version 8), first frame.
Model read_md2(std::string_view data, const std::string& name);

/// MegaGlest (G3D, version 4), first frame.
Model read_g3d(std::string_view data, const std::string& name);

/// Quake 3 (MD3, version 15): one frame of one part of a player, and the tags that other parts hang on.
struct Md3 {
  struct Tag {
    std::string name;
    Vec3 origin;
    Eigen::Matrix3d axes;  // columns
  };
  Model model;  // materials carry the surfaces' names
  std::vector<Tag> tags;
};
Md3 read_md3(std::string_view data, const std::string& name, int frame);

/// A Quake 3 player: lower.md3, upper.md3 at its tag_torso, head.md3 at upper's tag_head, textured by the
/// *_default.skin files. \param frames of lower, upper and head
Model read_player(const std::filesystem::path& folder, std::array<int, 3> frames);

/// Text: the number of vertices, then "x y z u v" for each; every three are a triangle.
Model read_raw(std::string_view data, const std::string& name);

/// A JavaScript module with exports.positions and exports.cells as base64 of typed arrays.
Model read_js(std::string_view data, const std::string& name);

/// Targa pictures: true colour, 24 or 32 bits, plain or run-length coded.
Picture read_tga(std::string_view data, const std::string& name);

}  // namespace carve::artist
