#include "artist/read_model.h"

#include <algorithm>
#include <set>

#include "artist/readers.h"
#include "carve/core/error.h"
#include "carve/core/file.h"

namespace carve::artist {
namespace {

Model read_source(const Entry& entry, const std::filesystem::path& folder) {
  static const std::set<std::string> by_assimp = {"3ds", "ac3d", "gltf", "off", "ply.gz", "blend"};
  const std::filesystem::path path = folder / entry.files.front();
  if (entry.format == "obj") return read_obj(path, entry.objects);
  if (entry.format == "inventor") return read_inventor(path);
  if (entry.format == "md3") return read_player(folder, entry.frames);
  if (entry.format == "md2") return read_md2(read_file(path), path.string());
  if (entry.format == "g3d") return read_g3d(read_file(path), path.string());
  if (entry.format == "raw") return read_raw(read_file(path), path.string());
  if (entry.format == "js") return read_js(read_file(path), path.string());
  if (by_assimp.contains(entry.format)) return read_assimp(path, entry.objects);
  throw IoError(entry.name, "unknown format " + entry.format);
}

}  // namespace

Model read_model(const Entry& entry, const std::filesystem::path& folder) {
  Model model = read_source(entry, folder);
  for (Material& material : model.materials) {
    const auto fetched = std::find(entry.files.begin(), entry.files.end(), material.texture);
    if (fetched == entry.files.end()) material.texture = entry.texture;  // nor are textures of unused faces
    for (const Material& colour : entry.colours)
      if (material.texture.empty() && (colour.name == "*" || colour.name == material.name))
        material.colour = colour.colour;
  }
  return place(model, entry.placement);
}

}  // namespace carve::artist
