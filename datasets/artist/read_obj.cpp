#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include "artist/readers.h"
#include "artist/triangulate.h"
#include "carve/core/error.h"
#include "carve/core/file.h"

namespace carve::artist {
namespace {

using Words = std::vector<std::string_view>;

Words split(std::string_view line) {
  Words words;
  for (std::size_t at = 0; (at = line.find_first_not_of(" \t\r\f\v", at)) != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(" \t\r\f\v", at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

// What follows the keyword: names may hold spaces.
std::string rest(std::string_view line) {
  const auto first = line.find_first_of(" \t"), last = line.find_last_not_of(" \t\r");
  const auto begin = line.find_first_not_of(" \t", first);
  return begin == std::string_view::npos ? "" : std::string(line.substr(begin, last + 1 - begin));
}

template <class T>
std::optional<T> number(std::string_view word) {
  T value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  if constexpr (std::is_floating_point_v<T>)
    if (!std::isfinite(value)) return std::nullopt;
  return value;
}

// The file's lines, trimmed at the left; `take` gets each with its keyword.
template <class Take>
void for_each_line(std::string_view text, Take&& take) {
  int line_number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view line = text.substr(at, end - at);
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    at = end + 1;
    ++line_number;
    const std::string_view keyword = line.substr(0, line.find_first_of(" \t\r"));
    if (!keyword.empty() && keyword[0] != '#') take(keyword, line, line_number);
  }
}

// "map_Kd -s 1 1 1 folder\name of.png" -> "name of.png"
std::string texture_name(std::string_view line) {
  std::string name = rest(line);
  while (!name.empty() && name[0] == '-') {  // an option and its numbers
    name = rest(name);
    while (number<double>(name.substr(0, name.find(' ')))) name = rest(name);
  }
  return name.substr(name.find_last_of("/\\") + 1);
}

void read_mtl(const std::filesystem::path& path, std::map<std::string, Material>& library) {
  Material* material = nullptr;
  for_each_line(read_file(path), [&](std::string_view keyword, std::string_view line, int line_number) {
    if (keyword == "newmtl") {
      material = &(library[rest(line)] = {rest(line)});
    } else if (material && keyword == "Kd") {
      const Words words = split(line);
      for (int i = 0; i < 3; ++i) {
        const auto value = i + 1 < static_cast<int>(words.size()) ? number<double>(words[i + 1]) : std::nullopt;
        if (!value) throw IoError(path.string(), "line " + std::to_string(line_number) + ": Kd needs three numbers");
        material->colour[i] = std::clamp(*value, 0.0, 1.0);
      }
    } else if (material && keyword == "map_Kd") {
      material->texture = texture_name(line);
    }
  });
}

class ObjReader {
 public:
  ObjReader(std::filesystem::path path, std::span<const std::string> objects)
      : path_(std::move(path)), objects_(objects), taking_(objects.empty()) {}

  Model read() {
    for_each_line(read_file(path_), [&](std::string_view keyword, std::string_view line, int line_number) {
      line_number_ = line_number;
      if (keyword == "v")
        model_.positions.push_back(vector<3>(line));
      else if (keyword == "vt")
        model_.texcoords.push_back(vector<2>(line));
      else if (keyword == "f")
        polygon(line);
      else if (keyword == "usemtl")
        use(rest(line));
      else if (keyword == "mtllib" && std::filesystem::exists(path_.parent_path() / rest(line)))
        read_mtl(path_.parent_path() / rest(line), library_);
      else if ((keyword == "o" || keyword == "g") && !objects_.empty())
        taking_ = std::find(objects_.begin(), objects_.end(), rest(line)) != objects_.end();
    });
    return std::move(model_);
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw IoError(path_.string(), "line " + std::to_string(line_number_) + ": " + why);
  }

  template <int N>
  Eigen::Matrix<double, N, 1> vector(std::string_view line) const {
    const Words words = split(line);
    Eigen::Matrix<double, N, 1> v;
    for (int i = 0; i < N; ++i) {
      const auto value = i + 1 < static_cast<int>(words.size()) ? number<double>(words[i + 1]) : std::nullopt;
      if (!value) fail("needs " + std::to_string(N) + " numbers");
      v[i] = *value;
    }
    return v;
  }

  // From 1, or from -1 = the last one read so far; -1 if there is none.
  int index(std::string_view word, std::size_t count) const {
    if (word.empty()) return -1;
    const auto value = number<long>(word);
    const long i = !value ? 0 : *value > 0 ? *value : *value + static_cast<long>(count) + 1;
    if (i < 1 || i > static_cast<long>(count)) fail("a face has a corner that is not there");
    return static_cast<int>(i - 1);
  }

  void polygon(std::string_view line) {
    if (!taking_) return;
    if (model_.materials.empty()) use("");
    const Words words = split(line);
    std::vector<Corner> corners;
    std::vector<Vec3> outline;
    for (std::size_t w = 1; w < words.size(); ++w) {
      const auto slash = std::min(words[w].find('/'), words[w].size());
      std::string_view texcoord = words[w].substr(std::min(slash + 1, words[w].size()));
      texcoord = texcoord.substr(0, texcoord.find('/'));
      corners.push_back(
          {index(words[w].substr(0, slash), model_.positions.size()), index(texcoord, model_.texcoords.size())});
      if (corners.back().position < 0) fail("a corner without a position");
      outline.push_back(model_.positions[corners.back().position]);
    }
    if (corners.size() < 3) fail("a face needs three corners");
    for (const auto& [a, b, c] : triangulate(outline))
      model_.faces.push_back({{corners[a], corners[b], corners[c]}, material_});
  }

  void use(const std::string& name) {
    const auto [found, fresh] = materials_.try_emplace(name, static_cast<int>(model_.materials.size()));
    if (fresh) model_.materials.push_back(library_.contains(name) ? library_.at(name) : Material{name});
    material_ = found->second;
  }

  std::filesystem::path path_;
  std::span<const std::string> objects_;
  bool taking_;
  int line_number_ = 0, material_ = 0;
  std::map<std::string, Material> library_;
  std::map<std::string, int> materials_;
  Model model_;
};

}  // namespace

Model read_obj(const std::filesystem::path& path, std::span<const std::string> objects) {
  Model model = ObjReader(path, objects).read();
  if (model.faces.empty()) throw IoError(path.string(), objects.empty() ? "no faces" : "no faces of these objects");
  return model;
}

}  // namespace carve::artist
