#include "run/heat_maps.h"

#include "carve/core/error.h"
#include "carve/image/read_image.h"
#include "carve/mesh/mesh_io.h"
#include "eval/compare.h"
#include "eval/heat_map.h"
#include "run/figures.h"

namespace carve::experiments {
namespace fs = std::filesystem;
namespace {

Picture figure(const fs::path& results, const std::vector<const Record*>& runs, double range) {
  const Mesh reference = read_mesh(results / kReferences / (runs.front()->provenance.at(kReferenceKey) + ".ply"));
  const MeshDistance distance(reference);
  const double diagonal = box_diagonal(reference), longest = diagonal / 100;  // a few pixels
  std::vector<HeatMap> maps;
  for (const Record* run : runs) {
    HeatMap map{run->method, with_short_edges(read_mesh(results / run->folder / "mesh.ply"), longest), {}};
    map.distances = signed_distances(map.mesh.positions, distance.nearest(map.mesh.positions), reference);
    maps.push_back(std::move(map));
  }
  return draw_heat_maps(maps, reference, diagonal, {.range = range, .show_reference = true});
}

}  // namespace

std::vector<fs::path> draw_heat_maps_of(const fs::path& folder, const Overview& overview,
                                        const std::vector<Record>& records) {
  std::vector<fs::path> written;
  fs::remove_all(folder / "heat_maps");  // the report shows what is there
  for (const Figure& wanted : figures_of(overview, records, overview.heat_map_models)) {
    if (!wanted.runs.front()->provenance.contains(kReferenceKey)) continue;
    fs::create_directories(folder / "heat_maps");
    written.push_back(folder / "heat_maps" / wanted.file);
    write_png(written.back(), figure(folder.parent_path(), wanted.runs, overview.heat_map_range));
  }
  return written;
}

}  // namespace carve::experiments
