#include <unistd.h>

#include <chrono>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "apps/command_line.h"
#include "carve/core/file.h"
#include "carve/image/read_image.h"
#include "carve/mesh/mesh_io.h"
#include "carve/pipeline/reconstruct.h"

namespace {
using namespace carve;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

struct Arguments {
  PipelineOptions options;
  std::map<View, fs::path> drawings;
  fs::path out, config, report;
  std::vector<fs::path> files;
  bool json = false;
  bool quiet = false;
};

Json json_of(const Drawing& drawing) {
  std::array<std::int64_t, 3> count{};
  for (const Label label : drawing.labels.pixels) ++count[static_cast<int>(label)];
  const Box& box = drawing.bounds;
  return {{"width", drawing.labels.width},
          {"height", drawing.labels.height},
          {"background", names(drawing.background)[static_cast<int>(drawing.background)]},
          {"border_colour", {drawing.border.r, drawing.border.g, drawing.border.b, drawing.border.a}},
          {"max_stroke", drawing.max_stroke},
          {"pixels", {{"background", count[0]}, {"surface", count[1]}, {"edge", count[2]}}},
          {"bounds", {{"x", box.x0}, {"y", box.y0}, {"width", box.width()}, {"height", box.height()}}}};
}

std::string axes(View view) {
  const auto text = [](SignedAxis a) { return std::string(a.sign > 0 ? "+" : "-") + "XYZ"[a.axis]; };
  const Frame f = frame(view);
  return "image right = " + text(f.right) + ", image up = " + text(f.up) + ", seen from " + text(f.toward);
}

// "chair_front.png" is a front drawing; without such a name the view is not known.
std::optional<View> view_named_by(const fs::path& path) {
  std::optional<View> found;
  for (const View view : kViews)
    if (path.stem().string().find(name(view)) != std::string::npos) {
      if (found) return std::nullopt;
      found = view;
    }
  return found;
}

int info(const Arguments& arguments) {
  Json all = Json::array();
  for (const fs::path& file : arguments.files) {
    const auto view = view_named_by(file);
    const Drawing drawing =
        read_drawings({{view.value_or(View::front), file}}, arguments.options.drawing).begin()->second;
    Json entry = {{"file", file.string()}};
    entry.update(json_of(drawing));
    entry["view"] = view ? Json(name(*view)) : Json();
    entry["axes"] = view ? Json(axes(*view)) : Json();
    all.push_back(entry);
    if (arguments.json) continue;
    const auto& pixels = entry["pixels"];
    std::cout << file.string() << ": " << drawing.labels.width << " x " << drawing.labels.height << " pixels\n"
              << "  background  " << entry["background"].get<std::string>() << "\n"
              << "  labels      " << pixels["background"] << " background, " << pixels["surface"] << " surface, "
              << pixels["edge"] << " edge (strokes up to " << drawing.max_stroke << " px wide)\n"
              << "  bounds      " << drawing.bounds.width() << " x " << drawing.bounds.height() << " at ("
              << drawing.bounds.x0 << ", " << drawing.bounds.y0 << ")\n"
              << "  axes        " << (view ? std::string(name(*view)) + ": " + axes(*view) : "the name tells no view")
              << "\n";
  }
  if (arguments.json) std::cout << all.dump(2) << '\n';
  return kDone;
}

int config(Arguments& arguments) {
  const std::string text = "# Options of carve build; read with --config.\n" + to_toml(fields(arguments.options));
  if (arguments.out.empty())
    std::cout << text;
  else
    write_file(arguments.out, [&](std::ostream& out) { out << text; });
  return kDone;
}

// Stages are told on stderr once the work has taken a second; short work stays silent.
Monitor progress_on_stderr(bool quiet) {
  const auto start = std::chrono::steady_clock::now();
  return {.progress = [=](std::string_view stage, double fraction) {
    if (quiet || std::chrono::steady_clock::now() - start < std::chrono::seconds(1)) return;
    std::cerr << "carve: " << static_cast<int>(100 * fraction) << " % " << stage << '\n';
  }};
}

Json json_of(const Arguments& arguments, const Reconstruction& result) {
  Json views = Json::object();
  for (std::size_t i = 0; i < result.views.views.size(); ++i) {
    const AlignedView& view = result.views.views[i];
    const ViewAgreement& fit = result.agreement[i];
    Json& entry = views[name(view.view)] = json_of(view.drawing);
    entry["axes"] = axes(view.view);
    entry["silhouette_iou"] = fit.silhouette_iou;
    entry["uncovered"] = fit.uncovered;
    entry["extra"] = fit.extra;
  }
  Json open_cells = Json::array();
  for (const OpenCell& cell : result.consistency.open_cells)
    open_cells.push_back({{"voxels", cell.voxels}, {"kept", cell.kept}, {"low", cell.low}, {"high", cell.high}});
  Json times = Json::object();
  for (const StageTime& time : result.times) times[time.stage] = time.seconds;
  Json refinement = Json::array();
  for (const RefinementStep& step : result.refinement)
    refinement.push_back({{"stage", step.stage},
                          {"kept", step.kept},
                          {"why", step.why},
                          {"put_back", step.put_back},
                          {"triangles", step.triangles},
                          {"self_intersections", step.self_intersections},
                          {"seconds", step.seconds}});
  const Topology& t = result.topology;
  Arguments copy = arguments;
  return {{"output", arguments.out.string()},
          {"size", {result.views.size.x(), result.views.size.y(), result.views.size.z()}},
          {"disagreement", result.views.disagreement},
          {"views", views},
          {"grid", {result.grid.size().x(), result.grid.size().y(), result.grid.size().z()}},
          {"voxels", result.grid.count()},
          {"consistency",
           {{"ran", names(result.consistency.ran)[static_cast<int>(result.consistency.ran)]},
            {"regions", result.consistency.regions},
            {"cells", result.consistency.cells},
            {"nodes", result.consistency.nodes},
            {"seconds", result.consistency.seconds},
            {"in_time", result.consistency.in_time},
            {"equal_solids", result.consistency.solids},
            {"all_equal_solids", result.consistency.all_solids},
            {"open_cells", open_cells}}},
          {"refinement", refinement},
          {"mesh",
           {{"vertices", t.vertices},
            {"triangles", t.triangles},
            {"components", t.components},
            {"genus", t.genus},
            {"closed", t.closed()},
            {"manifold", t.manifold()},
            {"oriented", t.oriented()},
            {"area", t.area},
            {"volume", t.volume}}},
          {"seconds", times},
          {"options", Json::parse(to_json(fields(copy.options)))}};
}

void refuse_to_overwrite_input(const Arguments& arguments) {
  std::vector<fs::path> all{arguments.out, arguments.report};
  if (arguments.options.texture.arm != TextureArm::none)
    for (const fs::path& beside : texture_files(arguments.out)) all.push_back(beside);
  for (const fs::path& written : all)
    for (const auto& [view, drawing] : arguments.drawings) {
      std::error_code ignored;
      if (!written.empty() && fs::equivalent(written, drawing, ignored))
        throw std::invalid_argument(written.string() + ": the output must not be the " + name(view) + " drawing");
    }
}

// The best arm where the format holds a texture; a texture that was asked for is never dropped.
void settle_texture(const fs::path& out, TextureArm& arm) {
  if (arm == TextureArm::automatic) arm = holds_texture(out) ? TextureArm::best_view : TextureArm::none;
  if (arm != TextureArm::none && !holds_texture(out))
    throw std::invalid_argument(out.string() + ": a texture needs .glb or .obj; for this format give --texture none");
}

int build(Arguments& arguments) {
  settle_texture(arguments.out, arguments.options.texture.arm);
  refuse_to_overwrite_input(arguments);
  const auto start = std::chrono::steady_clock::now();
  auto drawings = read_drawings(arguments.drawings, arguments.options.drawing);
  const double reading = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  Reconstruction result = reconstruct(std::move(drawings), arguments.options, progress_on_stderr(arguments.quiet));
  result.times.insert(result.times.begin(), {"read", reading});
  if (result.textured.texture.empty())
    write_mesh(arguments.out, result.mesh);
  else
    write_textured_mesh(arguments.out, result.textured);
  for (const RefinementStep& step : result.refinement)
    if (!step.why.empty() && !arguments.quiet)
      std::cerr << "carve: " << step.stage << (step.kept ? ": " : " was rolled back: ") << step.why << '\n';
  if (!arguments.report.empty())
    write_file(arguments.report, [&](std::ostream& out) { out << json_of(arguments, result).dump(2) << '\n'; });
  if (!arguments.quiet) {
    std::cout << arguments.out.string() << ": " << result.topology.triangles << " triangles, closed, from ";
    if (arguments.options.hull == HullMethod::none)
      std::cout << result.grid.count() << " voxels\n";
    else
      std::cout << "the contours' exact hull\n";
    for (const ViewAgreement& fit : result.agreement)
      if (fit.uncovered || fit.extra)
        std::cout << "  " << name(fit.view) << ": the drawings disagree on " << fit.uncovered + fit.extra
                  << " of its grid pixels (silhouette IoU " << fit.silhouette_iou << ")\n";
  }
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  const std::vector<Field> options = fields(arguments.options);
  CLI::App app("Turns orthographic drawings (front, side, top, ...) into a closed triangle mesh.", "carve");
  app.set_version_flag("--version", CARVE_VERSION);
  app.require_subcommand(1);
  app.footer("Exit codes: 0 done, 1 the work could not be done, 2 wrong usage or bad input.");

  CLI::App* build_command = app.add_subcommand("build", "two to six drawings to a mesh");
  for (const View view : kViews)
    build_command->add_option(std::string("--") + name(view), arguments.drawings[view], axes(view))->type_name("IMAGE");
  build_command->add_option("-o,--output", arguments.out, "mesh to write: .glb, .obj, .ply, .stl, .off")
      ->required()
      ->type_name("FILE");
  build_command
      ->add_option_function<std::string>(
          "--config", [&](const std::string& path) { from_toml(options, path, read_file(path)); },
          "options as TOML (see carve config); flags after it win")
      ->type_name("FILE")
      ->trigger_on_parse();
  build_command->add_option("--json", arguments.report, "write what was done as JSON")->type_name("FILE");
  add_threads_flag(*build_command);
  build_command->add_flag("-q,--quiet", arguments.quiet, "say nothing but errors");
  add_flags(*build_command, options);
  build_command->footer(
      "Examples:\n"
      "  carve build --front f.png --side s.png --top t.png -o model.glb\n"
      "  carve build --front f.png --top t.png -o model.ply --grid 256 --smooth-steps 4 --json report.json\n"
      "Images: PNG, JPEG, TIFF, WebP up to 16384 x 16384. The mesh's longest side is 1; it is centred on x and z and "
      "stands on y = 0.");

  CLI::App* info_command = app.add_subcommand("info", "what is understood of each drawing");
  info_command->add_option("drawings", arguments.files, "images; a name with front, side, ... in it tells the view")
      ->required()
      ->type_name("IMAGE");
  info_command->add_flag("--json", arguments.json, "JSON on standard output");
  std::vector<Field> drawing_options;
  add_fields(drawing_options, "drawing", arguments.options.drawing);
  add_flags(*info_command, drawing_options);
  info_command->footer("Example:\n  carve info front.png side.png top.png --json");

  CLI::App* config_command = app.add_subcommand("config", "every option with its default as TOML");
  config_command->add_option("file", arguments.out, "file to write; standard output without it")->type_name("FILE");
  config_command->footer("Example:\n  carve config options.toml && carve build ... --config options.toml");

  return run_program(app, argc, argv, [&] {
    std::erase_if(arguments.drawings, [](const auto& entry) { return entry.second.empty(); });
    if (info_command->parsed()) return info(arguments);
    if (config_command->parsed()) return config(arguments);
    return build(arguments);
  });
}
