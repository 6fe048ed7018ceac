// synthesize: base models to concept-art drawings.
#include <algorithm>
#include <filesystem>
#include <iostream>

#include "apps/command_line.h"
#include "carve/core/error.h"
#include "carve/core/file.h"
#include "carve/core/options.h"
#include "carve/image/read_image.h"
#include "carve/mesh/mesh_io.h"
#include "models/outer_surface.h"
#include "models/procedural.h"
#include "synthesize/synthesize.h"

namespace {
namespace fs = std::filesystem;
using namespace carve;

struct Arguments {
  std::vector<std::string> models = {"procedural"};
  std::string artist, out = "drawings";
  bool list = false;
  SynthesizeOptions options;
  DegradeOptions degrade;
  OuterSurfaceOptions outer;
};

std::vector<Field> fields(Arguments& arguments) {
  std::vector<Field> all;
  add_fields(all, "", arguments.options);
  add_fields(all, "degrade", arguments.degrade);
  add_fields(all, "outer_surface", arguments.outer);
  return all;
}

// Where models come from, by name, in the order they are listed.
std::vector<std::pair<std::string, fs::path>> artist_models(const std::string& folder) {
  std::vector<std::pair<std::string, fs::path>> found;
  if (folder.empty()) return found;
  if (!fs::is_directory(folder)) throw IoError(folder, "not a folder");
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file() || entry.path().extension() != ".obj") continue;
    const bool own_folder = entry.path().stem() == "model";
    found.emplace_back(own_folder ? entry.path().parent_path().filename() : entry.path().stem(), entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

void write_drawings(const std::string& name, const Model& model, Arguments& arguments) {
  const fs::path folder = fs::path(arguments.out) / name;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw IoError(folder.string(), "cannot write: " + error.message(), IoError::Side::output);
  // One view at a time: a drawing of 16384 x 16384 pixels takes a gigabyte.
  const std::vector<std::string> views = arguments.options.views;
  for (const std::string& view : views) {
    SynthesizeOptions one = arguments.options;
    one.views = {view};
    for (const auto& [_, picture] : synthesize(model, one, arguments.degrade))
      write_png(folder / (view + ".png"), picture);
  }
  write_model(folder, model);
  write_mesh(folder / "reference.ply", outer_surface(model, arguments.outer), {.strict = false});
  write_file(folder / "synthesize.toml", [&](std::ostream& out) { out << to_toml(fields(arguments)); });
  std::cout << folder.string() << ": " << model.mesh.triangles.size() << " triangles\n";
}

void run(Arguments& arguments) {
  const auto artist = artist_models(arguments.artist);
  std::vector<std::string> names;
  for (const std::string& wanted : arguments.models) {
    const bool all = wanted == "all", procedural = wanted == "procedural", artists = wanted == "artist";
    if (all || procedural)
      for (const ProceduralModel& model : procedural_models()) names.push_back(model.name);
    if (all || artists)
      for (const auto& [name, _] : artist) names.push_back(name);
    if (!all && !procedural && !artists) names.push_back(wanted);
  }
  for (const std::string& name : names) {
    const auto found = std::find_if(artist.begin(), artist.end(), [&](const auto& a) { return a.first == name; });
    write_drawings(name, found == artist.end() ? procedural_model(name) : placed(load_model(found->second)), arguments);
  }
}

void list(const Arguments& arguments) {
  for (const ProceduralModel& model : procedural_models()) std::cout << model.name << "\t" << model.stands_for << "\n";
  for (const auto& [name, path] : artist_models(arguments.artist)) std::cout << name << "\t" << path.string() << "\n";
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Orthographic concept-art drawings of base models", "synthesize");
  Arguments arguments;
  app.add_option("--model", arguments.models, "names, procedural, artist (all of --artist), or all")->delimiter(',');
  app.add_option("--artist", arguments.artist, "a folder of models: NAME.obj or NAME/model.obj");
  app.add_option("-o,--out", arguments.out, "a folder NAME is made in it for each model")->capture_default_str();
  app.add_flag("--list", arguments.list, "print the models' names and stop");
  add_threads_flag(app);
  const std::vector<Field> options = fields(arguments);
  add_flags(app, options);
  return run_program(app, argc, argv, [&] {
    if (arguments.list)
      list(arguments);
    else
      run(arguments);
    return kDone;
  });
}
