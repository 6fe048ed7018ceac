// photograph: base models to photos with known cameras, in the layouts of PMVS2 and COLMAP.
#include <filesystem>
#include <iostream>

#include "apps/command_line.h"
#include "carve/core/error.h"
#include "carve/core/file.h"
#include "carve/core/options.h"
#include "carve/core/parallel.h"
#include "carve/mesh/mesh_io.h"
#include "carve/photo/photo_files.h"
#include "carve/photo/rig.h"
#include "models/outer_surface.h"
#include "models/procedural.h"
#include "photograph/photograph.h"

namespace {
namespace fs = std::filesystem;
using namespace carve;

struct Arguments {
  std::vector<std::string> models;
  std::string out = "photos", layout = "both";
  int threads = 0;
  RigOptions rig;
  PoseNoiseOptions pose_noise;
  PhotographOptions photograph;
  SolidTextureOptions texture;
};

std::vector<Field> fields(Arguments& arguments) {
  std::vector<Field> all;
  add_fields(all, "rig", arguments.rig);
  add_fields(all, "pose_noise", arguments.pose_noise);
  add_fields(all, "photograph", arguments.photograph);
  add_fields(all, "solid_texture", arguments.texture);
  return all;
}

// A name of a procedural model, or the path of an OBJ file.
std::pair<std::string, Model> model_of(const std::string& text) {
  const fs::path path = text;
  if (path.extension() != ".obj") return {text, procedural_model(text)};
  const std::string stem = path.stem().string();
  return {stem == "model" ? fs::absolute(path).parent_path().filename().string() : stem, placed(load_model(path))};
}

void run(Arguments& arguments) {
  for (const std::string& text : arguments.models) {
    const auto [name, model] = model_of(text);
    const auto [low, high] = bounds(model.mesh);
    const std::vector<Camera> cameras = rig(low, high, arguments.rig);
    std::vector<Photo> photos = photograph(model, cameras, arguments.photograph, arguments.texture);
    const std::vector<Camera> told = with_pose_noise(cameras, (low + high) / 2, arguments.pose_noise);
    for (std::size_t i = 0; i < photos.size(); ++i) photos[i].camera = told[i];
    const fs::path folder = fs::path(arguments.out) / name;
    if (arguments.layout != "colmap") write_pmvs(folder / "pmvs", photos);
    if (arguments.layout != "pmvs") write_colmap(folder / "colmap", photos);
    write_mesh(folder / "reference.ply", outer_surface(model), {.strict = false});
    write_file(folder / "photograph.toml", [&](std::ostream& out) { out << to_toml(fields(arguments)); });
    std::cout << folder.string() << ": " << photos.size() << " photos\n";
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Photos of base models with known cameras, for PMVS2 and COLMAP", "photograph");
  Arguments arguments;
  app.add_option("models", arguments.models, "procedural models by name (synthesize --list), OBJ files by path")
      ->required()
      ->type_name("MODEL");
  app.add_option("-o,--out", arguments.out, "a folder NAME is made in it for each model")->capture_default_str();
  app.add_option("--layout", arguments.layout, "pmvs (visualize, txt, masks), colmap (images, masks, sparse) or both")
      ->check(CLI::IsMember({"pmvs", "colmap", "both"}))
      ->capture_default_str();
  app.add_option("--threads", arguments.threads, "0: all cores")->check(CLI::Range(0, 1024));
  const std::vector<Field> options = fields(arguments);
  add_flags(app, options);
  return run_program(app, argc, argv, [&] {
    set_thread_count(arguments.threads);
    run(arguments);
    return kDone;
  });
}
