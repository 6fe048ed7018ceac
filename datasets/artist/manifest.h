#pragma once
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "artist/place.h"

namespace carve::artist {

/// One model of manifest.toml, whose head describes the keys.
struct Entry {
  std::string name, object, group, package, format, licence, author, note;  // group: its own or its package's
  std::vector<std::string> files;    // names in the cache's folder of this model; the model itself first
  std::vector<std::string> objects;  // of the source that are taken; empty: all
  std::array<int, 3> frames = {};    // of an MD3 player
  std::string texture;               // for faces that name none
  std::vector<Material> colours;     // replace those of the source by material name; "*" is every one without texture
  Placement placement;
};

/// Models that nobody tunes on: a final measurement stays honest only if they are kept apart from all others.
inline bool held_out(const Entry& entry) { return entry.group == "held_out"; }

/// \throws IoError naming file and model: not TOML, a key missing or of the wrong type, a name or package used twice
/// or not known
std::vector<Entry> read_manifest(const std::filesystem::path& path);

}  // namespace carve::artist
