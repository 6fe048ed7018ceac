#include "artist/manifest.h"

#include <toml++/toml.h>

#include <charconv>
#include <map>
#include <set>

#include "carve/core/error.h"
#include "carve/core/file.h"

namespace carve::artist {
namespace {

// Reads one [[model]] or [[package]] table; errors name the file and the table.
class Table {
 public:
  Table(const toml::table& table, const std::filesystem::path& path, const std::set<std::string_view>& keys)
      : table_(table), path_(path.string()) {
    name_ = text("name");
    for (const auto& [key, value] : table)
      if (!keys.contains(key.str())) fail("unknown key " + std::string(key.str()));
  }
  [[noreturn]] void fail(const std::string& why) const {
    throw IoError(path_, (name_.empty() ? "" : name_ + ": ") + why);
  }
  std::string text(const char* key) const {
    const auto value = table_[key].value<std::string>();
    if (!value || value->empty()) fail(std::string(key) + " must be a text");
    return *value;
  }
  bool has(const char* key) const { return table_.contains(key); }
  std::string optional_text(const char* key) const { return has(key) ? text(key) : ""; }
  std::vector<std::string> texts(const char* key) const {
    std::vector<std::string> all;
    if (!table_.contains(key)) return all;
    const toml::array* array = table_[key].as_array();
    if (!array) fail(std::string(key) + " must be a list");
    for (const toml::node& node : *array) {
      const auto value = node.value<std::string>();
      if (!value) fail(std::string(key) + " must be a list of texts");
      all.push_back(*value);
    }
    return all;
  }
  std::array<int, 3> three_integers(const char* key) const {
    std::array<int, 3> numbers;
    for (int i = 0; i < 3; ++i) {
      const auto value = table_[key][i].value<int>();
      if (!value) fail(std::string(key) + " must be three integers");
      numbers[i] = *value;
    }
    return numbers;
  }
  // "NAME n n ...": the name, and `count` numbers behind the last spaces.
  std::pair<std::string, std::vector<double>> named_numbers(const std::string& line, int count) const {
    std::string name = line;
    std::vector<double> numbers(count);
    for (int i = count - 1; i >= 0; --i) {
      const auto space = name.rfind(' ');
      const std::string word = space == std::string::npos ? "" : name.substr(space + 1);
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), numbers[i]);
      if (word.empty() || error != std::errc() || end != word.data() + word.size())
        fail("\"" + line + "\" must be a name and " + std::to_string(count) + " numbers");
      name.erase(space);
    }
    return {name, numbers};
  }

 private:
  const toml::table& table_;
  std::string path_, name_;
};

Entry entry_of(const Table& table, const std::map<std::string, std::string>& group_of) {
  Entry e;
  e.name = table.text("name");
  e.object = table.text("object");
  e.package = table.text("package");
  if (!group_of.contains(e.package)) table.fail("no package " + e.package);
  e.group = table.has("group") ? table.text("group") : group_of.at(e.package);
  e.format = table.text("format");
  e.licence = table.text("licence");
  e.author = table.text("author");
  e.note = table.optional_text("note");
  for (const std::string& line : table.texts("files")) {
    const auto space = line.find(' ');
    if (space != 64) table.fail("\"" + line + "\" must be a sha256 and a path");
    e.files.push_back(std::filesystem::path(line.substr(space + 1)).filename().string());
  }
  if (e.files.empty()) table.fail("no files");
  e.objects = table.texts("objects");
  e.texture = table.optional_text("texture");
  if (table.has("frames")) e.frames = table.three_integers("frames");
  for (const std::string& line : table.texts("colours")) {
    const auto [name, rgb] = table.named_numbers(line, 3);
    e.colours.push_back({name, Vec3(rgb[0], rgb[1], rgb[2])});
  }
  e.placement.up = table.text("up");
  e.placement.front = table.text("front");
  for (const std::string& line : table.texts("turns")) {
    const auto [about, degrees] = table.named_numbers(line, 1);
    e.placement.turns.push_back({about, degrees[0]});
  }
  return e;
}

}  // namespace

std::vector<Entry> read_manifest(const std::filesystem::path& path) {
  static const std::set<std::string_view> package_keys = {"name", "kind", "version", "megabytes", "group", "sha256"};
  static const std::set<std::string_view> model_keys = {"name",    "object",  "package", "archive", "files", "format",
                                                        "licence", "author",  "up",      "front",   "turns", "objects",
                                                        "frames",  "texture", "colours", "note",    "group"};
  toml::table root;
  try {
    root = toml::parse(read_file(path), path.string());
  } catch (const toml::parse_error& error) {
    throw IoError(path.string(),
                  "line " + std::to_string(error.source().begin.line) + ": " + std::string(error.description()));
  }
  const auto for_each = [&](const char* what, const auto& keys, const auto& take) {
    if (const toml::array* tables = root[what].as_array())
      for (const toml::node& node : *tables)
        if (const toml::table* table = node.as_table()) take(Table(*table, path, keys));
  };
  std::map<std::string, std::string> group_of;
  for_each("package", package_keys, [&](const Table& table) {
    if (!group_of.emplace(table.text("name"), table.text("group")).second) table.fail("stands there twice");
  });
  std::vector<Entry> entries;
  std::set<std::string> names;
  for_each("model", model_keys, [&](const Table& table) {
    entries.push_back(entry_of(table, group_of));
    if (!names.insert(entries.back().name).second) table.fail("stands there twice");
  });
  if (entries.empty()) throw IoError(path.string(), "no models in it");
  return entries;
}

}  // namespace carve::artist
