#include "run/heat_maps.h"

#include <algorithm>

#include "carve/core/error.h"
#include "carve/image/read_image.h"
#include "carve/mesh/mesh_io.h"
#include "eval/compare.h"
#include "eval/heat_map.h"
#include "run/reference.h"

namespace carve::experiments {
namespace fs = std::filesystem;
namespace {

// The runs of one figure: one a method, in the methods' order, of the first seed there is.
std::vector<const Record*> runs_of(const std::vector<Record>& records, const Overview& overview,
                                   const std::string& model, const Settings& swept) {
  std::vector<const Record*> runs;
  for (const std::string& method : overview.methods)
    for (const Record& r : records)
      if (r.model == model && r.method == method && r.swept == swept && r.done()) {
        runs.push_back(&r);
        break;
      }
  return runs;
}

Picture figure(const fs::path& results, const std::vector<const Record*>& runs, double range) {
  const Mesh reference = read_mesh(results / kReferences / (runs.front()->provenance.at(kReferenceKey) + ".ply"));
  const MeshDistance distance(reference);
  std::vector<HeatMap> maps;
  for (const Record* run : runs) {
    HeatMap map{run->method, read_mesh(results / run->folder / "mesh.ply"), {}};
    map.distances = signed_distances(map.mesh.positions, distance.nearest(map.mesh.positions), reference);
    maps.push_back(std::move(map));
  }
  return draw_heat_maps(maps, reference, box_diagonal(reference), {.range = range, .show_reference = true});
}

}  // namespace

std::vector<fs::path> draw_heat_maps_of(const fs::path& folder, const Overview& overview,
                                        const std::vector<Record>& records) {
  std::vector<fs::path> written;
  for (const std::string& model : overview.heat_map_models) {
    std::vector<Settings> drawn;
    for (const Record& record : records) {
      if (record.model != model || !record.done() || !record.provenance.contains(kReferenceKey)) continue;
      if (std::find(drawn.begin(), drawn.end(), record.swept) != drawn.end()) continue;
      drawn.push_back(record.swept);
      const auto runs = runs_of(records, overview, model, record.swept);
      std::string name = model + (record.swept.empty() ? "" : "," + text_of(record.swept)) + ".png";
      std::replace(name.begin(), name.end(), '/', '_');
      fs::create_directories(folder / "heat_maps");
      written.push_back(folder / "heat_maps" / name);
      write_png(written.back(), figure(folder.parent_path(), runs, overview.heat_map_range));
    }
  }
  return written;
}

}  // namespace carve::experiments
