#include "run/models.h"

#include <fnmatch.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <stdexcept>

#include "carve/image/read_image.h"
#include "models/procedural.h"
#include "run/hash.h"

namespace carve::experiments {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kArtist = "artist/", kHeldOut = "held_out/", kDrawing = "drawing/";

fs::path folder_from(const char* variable, const char* otherwise) {
  const char* folder = std::getenv(variable);
  return folder ? folder : otherwise;
}
fs::path artist_folder() { return folder_from("CARVE_ARTIST_MODELS", CARVE_DATA_FOLDER "/artist"); }
fs::path drawing_folder() { return folder_from("CARVE_DRAWINGS", CARVE_DATA_FOLDER "/drawings"); }

fs::path held_out_folder() { return folder_from("CARVE_HELD_OUT_MODELS", CARVE_DATA_FOLDER "/held_out"); }

fs::path model_file(const fs::path& folder, const std::string& name) { return folder / name / (name + ".obj"); }

template <class Is>
void add_folders(const fs::path& parent, std::string_view prefix, Is&& is, std::vector<std::string>& names) {
  std::error_code none;
  std::vector<std::string> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(parent, none))
    if (is(entry.path())) found.push_back(std::string(prefix) + entry.path().filename().string());
  std::sort(found.begin(), found.end());
  names.insert(names.end(), found.begin(), found.end());
}

bool in_set(const std::string& set, const std::string& name) {
  static const std::set<std::string> thesis = {"axe", "dog", "head", "robot"};
  if (set == "thesis") return thesis.contains(name);
  if (set == "procedural") return name.find('/') == std::string::npos;
  if (set == "artist") return name.starts_with(kArtist);
  if (set == "held_out") return name.starts_with(kHeldOut);
  if (set == "drawing") return name.starts_with(kDrawing);
  throw std::invalid_argument("models: unknown set:" + set + "; sets: thesis, procedural, artist, held_out, drawing");
}

bool matches(const std::string& pattern, const std::string& name) {
  if (pattern.starts_with("set:")) return in_set(pattern.substr(4), name);
  if (name.starts_with(kHeldOut) && !pattern.starts_with(kHeldOut)) return false;
  return fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

}  // namespace

std::vector<std::string> known_subjects() {
  std::vector<std::string> names;
  for (const ProceduralModel& model : procedural_models()) names.push_back(model.name);
  const auto has_model = [](const fs::path& p) {
    return fs::exists(model_file(p.parent_path(), p.filename().string()));
  };
  add_folders(artist_folder(), kArtist, has_model, names);
  add_folders(held_out_folder(), kHeldOut, has_model, names);
  add_folders(
      drawing_folder(), kDrawing, [](const fs::path& p) { return fs::exists(p / "front.png"); }, names);
  return names;
}

std::vector<std::string> expand_subjects(const std::vector<std::string>& patterns) {
  const std::vector<std::string> known = known_subjects();
  std::vector<std::string> chosen;
  for (const std::string& pattern : patterns) {
    const bool set = pattern.starts_with("set:");
    bool any = false;
    for (const std::string& name : known) {
      if (!matches(pattern, name)) continue;
      any = true;
      if (std::find(chosen.begin(), chosen.end(), name) == chosen.end()) chosen.push_back(name);
    }
    if (!any && !set && pattern.find('/') == std::string::npos)  // with one: data that not every machine has
      throw std::invalid_argument("models: there is no " + pattern);
  }
  return chosen;
}

Subject make_subject(const std::string& name) {
  if (name.starts_with(kArtist)) return {load_model(model_file(artist_folder(), name.substr(kArtist.size()))), {}};
  if (name.starts_with(kHeldOut)) return {load_model(model_file(held_out_folder(), name.substr(kHeldOut.size()))), {}};
  if (!name.starts_with(kDrawing)) return {procedural_model(name), {}};
  Subject subject;
  for (const View view : kViews)
    if (const fs::path file =
            drawing_folder() / name.substr(kDrawing.size()) / (std::string(carve::name(view)) + ".png");
        fs::exists(file))
      subject.drawings.emplace(view, read_image(file));
  return subject;
}

std::string content_hash(const Subject& subject) {
  Hash hash;
  if (subject.model) {
    const Model& model = *subject.model;
    hash.add_values(model.mesh.positions.data(), model.mesh.positions.size());
    hash.add_values(model.mesh.triangles.data(), model.mesh.triangles.size());
    hash.add_values(model.material.data(), model.material.size());
    hash.add_values(model.uv.data(), model.uv.size());
    for (const Material& material : model.materials) {
      hash.add_values(&material.colour, 1);
      hash.add_values(material.texture.pixels.data(), material.texture.pixels.size());
    }
  }
  for (const auto& [view, picture] : subject.drawings) {
    hash.add(name(view));
    hash.add_values(picture.pixels.data(), picture.pixels.size());
  }
  return hash.hex();
}

}  // namespace carve::experiments
