#include <algorithm>
#include <cstdlib>
#include <iostream>

#include "apps/command_line.h"
#include "artist/read_model.h"
#include "artist/write_model.h"
#include "carve/core/error.h"
#include "carve/mesh/topology.h"

namespace {
using namespace carve;
using namespace carve::artist;
namespace fs = std::filesystem;

// As in fetch: an empty variable is an unset one.
fs::path default_cache() {
  const auto variable = [](const char* name) { return std::string(std::getenv(name) ? std::getenv(name) : ""); };
  const std::string cache = variable("XDG_CACHE_HOME"), home = variable("HOME");
  return (!cache.empty() ? fs::path(cache) : fs::path(!home.empty() ? home : "/tmp") / ".cache") / "carve/artist";
}

bool fetched(const Entry& entry, const fs::path& cache) {
  return std::all_of(entry.files.begin(), entry.files.end(),
                     [&](const std::string& file) { return fs::is_regular_file(cache / entry.name / file); });
}

std::string describe(const Model& model) {
  Mesh mesh{model.positions, {}};
  for (const Face& f : model.faces)
    mesh.triangles.push_back({f.corners[0].position, f.corners[1].position, f.corners[2].position});
  const Topology t = topology(mesh);
  std::string text = std::to_string(t.triangles) + " triangles, " + std::to_string(t.components) + " parts, ";
  if (t.boundary_edges + t.nonmanifold_edges == 0)
    text += "watertight";
  else
    text += std::to_string(t.boundary_edges) + " boundary and " + std::to_string(t.nonmanifold_edges) +
            " non-manifold edges";
  if (t.misoriented_edges > 0) text += ", " + std::to_string(t.misoriented_edges) + " misoriented";
  if (t.volume < 0) text += ", inside out";
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Turns fetched artist models into OBJ: +Y up, +Z front, longest side 1, standing on y = 0",
               "carve-import");
  fs::path manifest = CARVE_ARTIST_MANIFEST, cache = default_cache(), out;
  std::vector<std::string> wanted;
  bool list = false, of_held_out = false;
  app.add_option("--manifest", manifest, "manifest.toml")->capture_default_str();
  app.add_option("--cache", cache, "the folder that fetch filled")->capture_default_str();
  app.add_option("-o,--out", out, "a model is written to OUT/NAME/NAME.obj");
  app.add_flag("--list", list, "print group, object, format and name of every model of the manifest");
  app.add_flag("--held-out", of_held_out, "without names: the held-out models in place of all others");
  app.add_option("models", wanted, "names; without any: all that are fetched and not held out");

  return run_program(app, argc, argv, [&] {
    const std::vector<Entry> entries = read_manifest(manifest);
    for (const std::string& name : wanted)
      if (std::none_of(entries.begin(), entries.end(), [&](const Entry& e) { return e.name == name; }))
        throw std::invalid_argument("no model " + name + " in " + manifest.string());
    if (!list && out.empty()) throw std::invalid_argument("--out is missing");
    int done = 0, absent = 0;
    for (const Entry& entry : entries) {
      if (list) {
        std::cout << entry.group << ' ' << entry.object << ' ' << entry.format << ' ' << entry.name << '\n';
        continue;
      }
      const bool named = std::find(wanted.begin(), wanted.end(), entry.name) != wanted.end();
      if (wanted.empty() ? held_out(entry) != of_held_out : !named) continue;
      if (!fetched(entry, cache)) {
        if (named)
          throw IoError((cache / entry.name).string(), "not fetched (datasets/artist/fetch " + entry.name + ")");
        ++absent;
        continue;
      }
      const Model model = read_model(entry, cache / entry.name);
      write_model(out / entry.name, model, cache / entry.name);
      std::cout << entry.name << ": " << describe(model) << std::endl;
      ++done;
    }
    if (list) return kDone;
    if (absent > 0) std::cout << absent << " models are not fetched\n";
    if (done == 0) std::cerr << "carve-import: nothing in " << cache.string() << ": run datasets/artist/fetch\n";
    return done > 0 ? kDone : kFailed;
  });
}
