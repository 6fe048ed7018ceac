#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/command_line.h"
#include "carve/image/read_image.h"
#include "carve/mesh/mesh_io.h"
#include "carve/views/read_drawings.h"
#include "eval/about.h"
#include "eval/texture_scores.h"
#include "eval/texture_sheet.h"

namespace {
using namespace carve;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

struct Arguments {
  fs::path model, sheet, differences;
  std::map<View, fs::path> drawings;
  DrawingOptions drawing;
  AlignOptions align;
  int size = 400;
  bool json = false;
};

int check_texture(const Arguments& arguments) {
  const TexturedMesh model = read_textured_mesh(arguments.model);
  const AtlasScores atlas = atlas_scores(model);
  std::map<View, Drawing> drawings = read_drawings(arguments.drawings, arguments.drawing);
  std::optional<RoundTrip> trip;
  if (!drawings.empty()) {
    const ViewSet views = align(std::move(drawings), arguments.align);
    trip = about(arguments.model, [&] { return round_trip(model, views); });
    if (!arguments.differences.empty()) write_png(arguments.differences, differences(model, views));
  } else if (!arguments.differences.empty()) {
    throw std::invalid_argument("--differences needs the drawings: --front, --side, --top");
  }
  if (!arguments.sheet.empty()) write_png(arguments.sheet, texture_sheet(model, arguments.size));
  const int result = atlas.flipped + atlas.overlap + atlas.outside > 0 ? kCheckFailed : kDone;
  if (!arguments.json) {
    std::cout << arguments.model.string() << "\n" << atlas;
    if (trip) std::cout << *trip;
    return result;
  }
  Json report = {
      {"file", arguments.model.string()}, {"charts", atlas.charts},           {"packing", atlas.packing},
      {"distortion", atlas.distortion},   {"flipped", atlas.flipped},         {"overlap", atlas.overlap},
      {"outside", atlas.outside},         {"seam_length", atlas.seam_length}, {"seam_contrast", atlas.seam_contrast}};
  const auto number = [](const std::optional<double>& value) { return value ? Json(*value) : Json(); };
  if (trip)
    report.update({{"psnr", number(trip->psnr)},
                   {"psnr_all", number(trip->psnr_all)},
                   {"psnr_raw", number(trip->psnr_raw)},
                   {"ssim", number(trip->ssim)},
                   {"ghosting", number(trip->ghosting)}});
  std::cout << report.dump(2) << '\n';
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("What a model's texture is like: its atlas, and the drawings it was made from seen on the model.",
               "texture_check");
  app.add_option("model", arguments.model, ".glb with its picture inside")->required()->type_name("FILE");
  for (const View view : kViews)
    app.add_option(std::string("--") + name(view), arguments.drawings[view], "drawing")->type_name("IMAGE");
  app.add_flag("--json", arguments.json, "JSON on standard output");
  app.add_option("--sheet", arguments.sheet, "picture of the model from four sides, its texture beside")
      ->type_name("FILE");
  app.add_option("--differences", arguments.differences,
                 "picture of every drawing, the model seen in it and where their colours differ")
      ->type_name("FILE");
  app.add_option("--size", arguments.size, "pixels along a picture's side")->check(CLI::Range(32, 4096));
  add_threads_flag(app);
  std::vector<Field> options;
  add_fields(options, "drawing", arguments.drawing);
  add_fields(options, "align", arguments.align);
  add_flags(app, options);
  app.footer(
      "Example:\n  texture_check model.glb --front f.png --side s.png --top t.png --sheet model.png\n"
      "Exit codes: 0 done, 1 the work could not be done, 2 wrong usage or bad input, 3 charts overlap, lie face down "
      "or\n"
      "leave the texture.");
  return run_program(app, argc, argv, [&] {
    std::erase_if(arguments.drawings, [](const auto& entry) { return entry.second.empty(); });
    return check_texture(arguments);
  });
}
