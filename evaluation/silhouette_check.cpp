#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/command_line.h"
#include "carve/image/read_image.h"
#include "carve/mesh/mesh_io.h"
#include "carve/views/read_drawings.h"
#include "eval/about.h"
#include "eval/silhouette.h"

namespace {
using namespace carve;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

struct Arguments {
  fs::path mesh, overlays;
  std::map<View, fs::path> drawings;
  DrawingOptions drawing;
  AlignOptions align;
  SilhouetteOptions options;
  bool json = false;
};

int check_silhouettes(const Arguments& arguments) {
  const Mesh mesh = read_mesh(arguments.mesh);
  const ViewSet views = align(read_drawings(arguments.drawings, arguments.drawing), arguments.align);
  const SilhouetteScores scores =
      about(arguments.mesh, [&] { return silhouette_scores(mesh, views, arguments.options); });

  if (!arguments.overlays.empty())
    for (const ViewScore& v : scores.views)
      write_png(arguments.overlays / (std::string(name(v.view)) + ".png"), v.overlay);
  const bool pass = scores.least_iou() >= arguments.options.least_iou;
  if (arguments.json) {
    Json report = {{"file", arguments.mesh.string()}, {"pass", pass}, {"wanted_iou", arguments.options.least_iou}};
    report.update(Json::parse(to_json(scores)));
    std::cout << report.dump(2) << '\n';
  } else {
    std::cout << arguments.mesh.string() << ", placed by " << names(scores.fit)[static_cast<int>(scores.fit)] << ": "
              << (pass ? "pass" : "FAIL") << " (least IoU " << scores.least_iou() << ", wanted "
              << arguments.options.least_iou << ")\n"
              << scores;
  }
  return pass ? kDone : kCheckFailed;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Whether a mesh, seen from the drawings' sides, has their silhouettes and strokes.", "silhouette_check");
  app.add_option("mesh", arguments.mesh, ".ply .obj .off .stl .glb")->required()->type_name("FILE");
  for (const View view : kViews)
    app.add_option(std::string("--") + name(view), arguments.drawings[view], "drawing")->type_name("IMAGE");
  app.add_flag("--json", arguments.json, "JSON on standard output");
  app.add_option("--overlays", arguments.overlays, "folder for one picture a view: drawing and mesh over each other")
      ->check(CLI::ExistingDirectory);
  add_threads_flag(app);
  std::vector<Field> options;
  add_fields(options, "", arguments.options);
  add_fields(options, "drawing", arguments.drawing);
  add_fields(options, "align", arguments.align);
  add_flags(app, options);
  app.footer(
      "Example:\n  silhouette_check model.glb --front f.png --side s.png --top t.png --least-iou 0.98\n"
      "Exit codes: 0 pass, 1 the work could not be done, 2 wrong usage or bad input, 3 a view's IoU is too low.");
  return run_program(app, argc, argv, [&] {
    std::erase_if(arguments.drawings, [](const auto& entry) { return entry.second.empty(); });
    return check_silhouettes(arguments);
  });
}
