#include "run/reference.h"

#include "carve/image/read_image.h"
#include "carve/mesh/mesh_io.h"
#include "models/outer_surface.h"
#include "run/hash.h"

namespace carve::experiments {
namespace fs = std::filesystem;

Mesh reference_of(const fs::path& results, const Model& model, const std::string& content) {
  const fs::path file = results / kReferences / (content + ".ply");
  if (fs::exists(file)) return read_mesh(file);
  Mesh outer = outer_surface(model);
  fs::create_directories(file.parent_path());
  // Two runs may come here at once, and below: each writes the same bytes, whole.
  write_mesh(file, outer, {.strict = false});
  return outer;
}

std::map<View, Picture> concept_art_of(const fs::path& results, const Model& model, const std::string& content,
                                       RunOptions& options) {
  Hash hash;
  hash.add(program_hash()).add(content);
  for (const Field& field : fields(options))
    if (field.name.starts_with("synthesize.") || field.name.starts_with("degrade."))
      hash.add(field.name).add(field.get());
  const fs::path folder = results / kConceptArt / hash.hex();
  const auto file = [&](View view) { return folder / (std::string(name(view)) + ".png"); };
  std::map<View, Picture> pictures;
  for (const View view : kViews)
    if (fs::exists(file(view))) pictures.emplace(view, read_image(file(view)));
  if (pictures.size() == options.synthesize.views.size()) return pictures;
  pictures = synthesize(model, options.synthesize, options.degrade);
  fs::create_directories(folder);
  for (const auto& [view, picture] : pictures) write_png(file(view), picture);
  return pictures;
}

}  // namespace carve::experiments
