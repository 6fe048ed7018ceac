#include "carve/mesh/mesh_io.h"

#include <algorithm>
#include <stdexcept>

#include "carve/core/file.h"
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

}  // namespace

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

}  // namespace carve
