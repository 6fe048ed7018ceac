#include "run/reference.h"

#include "carve/mesh/mesh_io.h"
#include "models/outer_surface.h"

namespace carve::experiments {
namespace fs = std::filesystem;

Mesh reference_of(const fs::path& results, const Model& model, const std::string& content) {
  const fs::path file = results / kReferences / (content + ".ply");
  if (fs::exists(file)) return read_mesh(file);
  Mesh outer = outer_surface(model);
  fs::create_directories(file.parent_path());
  // Two runs may come here at once: each writes the same bytes, whole.
  write_mesh(file, outer, {.strict = false});
  return outer;
}

}  // namespace carve::experiments
