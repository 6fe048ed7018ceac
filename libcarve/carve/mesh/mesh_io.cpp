#include "carve/mesh/mesh_io.h"

#include <algorithm>
#include <stdexcept>

#include "carve/core/file.h"
#include "carve/image/read_image.h"
#include "carve/mesh/formats.h"
#include "carve/mesh/ply.h"

namespace carve {
namespace fs = std::filesystem;
namespace {

struct Format {
  const char* ending;
  Mesh (*read)(const std::string& path, std::string_view bytes);
  void (*write)(std::ostream& out, const Mesh& mesh);
};
void write_plain_ply(std::ostream& out, const Mesh& mesh) { formats::write_ply(out, mesh, {}); }
constexpr Format kFormats[] = {{".ply", formats::read_ply, write_plain_ply},
                               {".obj", formats::read_obj, formats::write_obj},
                               {".off", formats::read_off, formats::write_off},
                               {".stl", formats::read_stl, formats::write_stl},
                               {".glb", formats::read_glb, formats::write_glb}};

// Null for an ending that is none of ours.
const Format* format_of(const fs::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  const auto found = std::find_if(std::begin(kFormats), std::end(kFormats),
                                  [&](const Format& format) { return ending == format.ending; });
  return found == std::end(kFormats) ? nullptr : found;
}

std::string unknown_ending(const fs::path& path) {
  std::string endings;
  for (const Format& format : kFormats) endings += (endings.empty() ? "" : ", ") + std::string(format.ending);
  return "a mesh file's ending must be one of " + endings + ", got " + formats::excerpt(path.extension().string());
}

bool has_ending(const fs::path& path, const char* ending) {
  const Format* format = format_of(path);
  return format && std::string(format->ending) == ending;
}

void check_texture(const std::string& path, const TexturedMesh& textured) {
  if (textured.uv_triangles.size() != textured.mesh.triangles.size())
    throw std::invalid_argument(path + ": uv_triangles must be as many as the mesh's triangles, " +
                                std::to_string(textured.mesh.triangles.size()) + ", got " +
                                std::to_string(textured.uv_triangles.size()));
  for (const Triangle& triangle : textured.uv_triangles)
    for (const int i : triangle)
      if (std::size_t(i) >= textured.uvs.size())
        throw std::invalid_argument(path + ": uv_triangles must index one of " + std::to_string(textured.uvs.size()) +
                                    " uvs, got " + std::to_string(i));
  if (!std::all_of(textured.uvs.begin(), textured.uvs.end(), [](const Vec2& uv) { return uv.allFinite(); }))
    throw std::invalid_argument(path + ": uvs must be finite");
}

// The picture, the material that names it, then the mesh that names the material.
void write_obj_files(const fs::path& path, const TexturedMesh& textured) {
  const std::vector<fs::path> beside = texture_files(path);
  const fs::path &picture = beside[0], &material = beside[1];
  const std::string bytes = encode_png(textured.texture);
  write_file(picture, [&](std::ostream& out) { out.write(bytes.data(), static_cast<std::streamsize>(bytes.size())); });
  write_file(material, [&](std::ostream& out) {
    out << "newmtl texture\nKa 1 1 1\nKd 1 1 1\nKs 0 0 0\nillum 1\nmap_Kd " << picture.filename().string() << "\n";
  });
  write_file(path,
             [&](std::ostream& out) { formats::write_textured_obj(out, textured, material.filename().string()); });
}

}  // namespace

bool holds_texture(const fs::path& path) { return has_ending(path, ".glb") || has_ending(path, ".obj"); }

std::vector<fs::path> texture_files(const fs::path& path) {
  if (!has_ending(path, ".obj")) return {};
  return {fs::path(path).replace_extension(".png"), fs::path(path).replace_extension(".mtl")};
}

void write_textured_mesh(const fs::path& path, const TexturedMesh& textured, const WriteOptions& options) {
  if (textured.texture.empty() || !holds_texture(path)) return write_mesh(path, textured.mesh, options);
  check_texture(path.string(), textured);
  formats::check_writable(path.string(), textured.mesh, options);
  if (has_ending(path, ".obj")) return write_obj_files(path, textured);
  write_file(path, [&](std::ostream& out) { formats::write_textured_glb(out, textured); });
}

void write_mesh(const fs::path& path, const Mesh& mesh, const WriteOptions& options) {
  const Format* format = format_of(path);
  if (!format) throw std::invalid_argument(path.string() + ": " + unknown_ending(path));
  formats::check_writable(path.string(), mesh, options);
  write_file(path, [&](std::ostream& out) { format->write(out, mesh); });
}

Mesh formats::read(const fs::path& path, std::string_view bytes) {
  const Format* format = format_of(path);
  if (!format) throw IoError(path.string(), unknown_ending(path));
  return format->read(path.string(), bytes);
}

Mesh read_mesh(const fs::path& path) {
  if (!format_of(path)) throw IoError(path.string(), unknown_ending(path));
  return formats::read(path, read_file(path));
}

TexturedMesh read_textured_mesh(const fs::path& path) {
  if (!has_ending(path, ".glb")) throw IoError(path.string(), "a mesh with its texture is read from .glb only");
  return formats::read_textured_glb(path.string(), read_file(path));
}

}  // namespace carve
