#include <iostream>

#include "apps/command_line.h"
#include "carve/core/file.h"
#include "carve/mesh/mesh_io.h"
#include "eval/about.h"
#include "eval/error_split.h"
#include "eval/report.h"

namespace {
using namespace carve;
namespace fs = std::filesystem;

struct Arguments {
  std::vector<fs::path> compared;
  fs::path reference, csv;
  CompareOptions options;
  bool json = false, split = false;
};

Row measured(const fs::path& file, const Reference& reference) {
  if (auto cloud = PlyCloud::open(file))
    return {file.string(), cloud->size(), 0, scores(reference.compare(*cloud), reference)};
  const Mesh mesh = read_mesh(file);
  const Comparison comparison = about(file, [&] { return reference.compare(mesh); });
  return {file.string(), mesh.positions.size(), mesh.triangles.size(), scores(comparison, reference)};
}

int compare(const Arguments& arguments) {
  check("", arguments.options);
  const Reference reference =
      about(arguments.reference, [&] { return Reference(read_mesh(arguments.reference), arguments.options); });
  const ReportHead head{arguments.reference.string(), reference.mesh().positions.size(),
                        reference.mesh().triangles.size(), reference.diagonal(), arguments.options};
  std::vector<Row> rows;
  std::vector<Stage> stages;
  for (const fs::path& file : arguments.compared) {
    rows.push_back(measured(file, reference));
    if (arguments.split) stages.push_back({file.stem().string(), read_mesh(file)});
  }
  if (!arguments.csv.empty()) write_file(arguments.csv, [&](std::ostream& out) { write_csv(out, head, rows); });
  if (arguments.json)
    std::cout << to_json(head, rows) << '\n';
  else
    write_text(std::cout, head, rows);
  if (arguments.split) std::cout << "\nsplit of chamfer_l1\n" << split_error(reference, stages);
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Distances and other metrics of meshes or clouds to a reference mesh.", "cloud_to_mesh");
  app.add_option("compared", arguments.compared, "meshes: .ply .obj .off .stl .glb; or clouds: binary .ply of any size")
      ->required()
      ->type_name("FILE");
  add_reference_flag(app, arguments.reference);
  const auto json = app.add_flag("--json", arguments.json, "JSON on standard output");
  app.add_flag("--split", arguments.split,
               "the compared meshes are stages (exact hull, voxels, result): what each adds to the error")
      ->excludes(json);
  app.add_option("--csv", arguments.csv, "also write a line a file and metric")->type_name("FILE");
  add_threads_flag(app);
  std::vector<Field> options;
  add_fields(options, "", arguments.options);
  add_flags(app, options);
  app.footer(
      "Examples:\n  cloud_to_mesh a.ply b.obj --reference truth.ply --tolerances 0.5,1 --csv scores.csv\n"
      "  cloud_to_mesh hull.ply voxels.ply smooth.ply --reference truth.ply --split\n"
      "    (carve build --hull strips; --consistency none --convex off --smooth-steps 0; the same smoothed)\n"
      "Exit codes: 0 done, 1 the work could not be done, 2 wrong usage or bad input.");
  return run_program(app, argc, argv, [&] { return compare(arguments); });
}
