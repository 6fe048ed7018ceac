#include "eval/heat_map.h"

#include <iostream>

#include "apps/command_line.h"
#include "carve/mesh/mesh_io.h"
#include "eval/about.h"
#include "eval/compare.h"

namespace {
using namespace carve;
namespace fs = std::filesystem;

struct Arguments {
  std::vector<fs::path> compared, out;
  std::vector<std::string> titles;
  fs::path reference;
  HeatMapOptions options;
};

int draw(const Arguments& arguments) {
  check("", arguments.options);
  for (const fs::path& path : arguments.out) check_heat_output(path, arguments.compared.size());
  if (!arguments.titles.empty() && arguments.titles.size() != arguments.compared.size())
    throw std::invalid_argument("titles must be one a compared mesh");
  const Mesh reference = read_mesh(arguments.reference);
  const double diagonal = box_diagonal(reference);
  const auto distance = about(arguments.reference, [&] { return MeshDistance(reference); });
  std::vector<HeatMap> maps;
  for (const fs::path& file : arguments.compared) {
    const std::string title = arguments.titles.empty() ? file.stem().string() : arguments.titles[maps.size()];
    HeatMap map{title, read_mesh(file), {}};
    map.distances = signed_distances(map.mesh.positions, distance.nearest(map.mesh.positions), reference);
    maps.push_back(std::move(map));
  }
  for (const fs::path& path : arguments.out) write_heat_maps(path, maps, reference, diagonal, arguments.options);
  const double range = heat_range(maps, diagonal, arguments.options);
  std::cout << "range " << 100 * range / diagonal << " % of the reference's diagonal (" << range << ")\n";
  for (const HeatMap& map : maps)
    std::cout << map.title << ": " << 100 * saturated_share(map, range) << " % of the vertices beyond it\n";
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Colours meshes by their distance to a reference; several side by side on one scale.", "heat_map");
  app.add_option("compared", arguments.compared, ".ply .obj .off .stl .glb")->required()->type_name("FILE");
  add_reference_flag(app, arguments.reference);
  app.add_option("-o,--output", arguments.out, "picture (.png), or one coloured mesh (.ply, .vtp); may be repeated")
      ->required()
      ->type_name("FILE");
  app.add_option("--titles", arguments.titles, "one a compared mesh; their files' names without it")->delimiter(',');
  add_threads_flag(app);
  std::vector<Field> options;
  add_fields(options, "", arguments.options);
  add_flags(app, options);
  app.footer(
      "Example:\n  heat_map hull.ply ours.ply --reference truth.ply -o figure.png --titles \"Voxel Carving,ours\" "
      "--range 5\n"
      "Exit codes: 0 done, 1 the work could not be done, 2 wrong usage or bad input.");
  return run_program(app, argc, argv, [&] { return draw(arguments); });
}
