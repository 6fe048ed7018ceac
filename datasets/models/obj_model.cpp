#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <ostream>

#include "carve/core/error.h"
#include "carve/core/file.h"
#include "carve/image/read_image.h"
#include "models/model.h"

namespace carve {
namespace {
namespace fs = std::filesystem;

// One text file, line by line, in words.
class Lines {
 public:
  explicit Lines(const fs::path& path) : path_(path), text_(read_file(path)) {}

  bool next() {
    while (begin_ < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', begin_), text_.size());
      std::string_view line(text_.data() + begin_, end - begin_);
      begin_ = end + 1;
      ++number_;
      line = line.substr(0, line.find('#'));
      words_.clear();
      constexpr std::string_view kSpace = " \t\r\v\f";
      for (std::size_t i = line.find_first_not_of(kSpace); i < line.size(); i = line.find_first_not_of(kSpace, i)) {
        const std::size_t stop = std::min(line.find_first_of(kSpace, i), line.size());
        words_.push_back(line.substr(i, stop - i));
        i = stop;
      }
      if (!words_.empty()) return true;
    }
    return false;
  }

  std::string_view key() const { return words_[0]; }
  std::size_t values() const { return words_.size() - 1; }
  std::string_view word(std::size_t i) const {
    if (i >= words_.size()) fail(std::string(key()) + " must have " + std::to_string(i) + " values or more");
    return words_[i];
  }
  // File and material names may hold spaces.
  std::string rest() const {
    word(1);
    return std::string(words_[1].data(), words_.back().data() + words_.back().size());
  }
  double number(std::size_t i) const {
    const std::string_view text = word(i);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
      fail(std::string(key()) + " must be a finite number, got " + std::string(text));
    return value;
  }
  [[noreturn]] void fail(const std::string& why) const {
    throw IoError(path_.string() + ":" + std::to_string(number_), why);
  }

 private:
  fs::path path_;
  std::string text_;
  std::size_t begin_ = 0;
  int number_ = 0;
  std::vector<std::string_view> words_;
};

std::uint8_t channel(double share) { return static_cast<std::uint8_t>(std::lround(std::clamp(share, 0.0, 1.0) * 255)); }

void read_materials(const fs::path& path, std::vector<Material>& materials) {
  Lines lines(path);
  while (lines.next()) {
    if (lines.key() == "newmtl") {
      materials.push_back({lines.rest(), {180, 180, 180}});
    } else if (lines.key() == "Kd" || lines.key() == "map_Kd") {
      if (materials.empty()) lines.fail(std::string(lines.key()) + " stands before any newmtl");
      if (lines.key() == "Kd")
        materials.back().colour = {channel(lines.number(1)), channel(lines.number(2)), channel(lines.number(3))};
      else if (lines.word(1).front() == '-')
        lines.fail("map_Kd options are not supported");
      else
        materials.back().texture = read_image(path.parent_path() / lines.rest());
    }
  }
}

class ObjReader {
 public:
  explicit ObjReader(const fs::path& path) : path_(path), lines_(path) {}

  Model read() {
    while (lines_.next()) {
      const std::string_view key = lines_.key();
      if (key == "v") model_.mesh.positions.emplace_back(lines_.number(1), lines_.number(2), lines_.number(3));
      if (key == "vt") texture_points_.emplace_back(lines_.number(1), lines_.values() > 1 ? lines_.number(2) : 0.0);
      if (key == "mtllib") read_materials(path_.parent_path() / lines_.rest(), model_.materials);
      if (key == "usemtl") use(lines_.rest());
      if (key == "f") face();
    }
    if (model_.mesh.triangles.empty()) throw IoError(path_.string(), "no faces");
    if (!any_uv_) model_.uv.clear();
    return std::move(model_);
  }

 private:
  struct Corner {
    int position;
    Vec2 uv;
  };

  void use(const std::string& name) {
    for (std::size_t i = 0; i < model_.materials.size(); ++i)
      if (model_.materials[i].name == name) return void(current_ = static_cast<int>(i));
    lines_.fail("usemtl " + name + ": no such material");
  }

  // 1-based, or counted back from the end if negative.
  int index(std::string_view text, std::size_t count, const char* what) const {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (value < 0) value += static_cast<std::int64_t>(count) + 1;
    if (error != std::errc() || end != text.data() + text.size() || value < 1 ||
        value > static_cast<std::int64_t>(count))
      lines_.fail("f: " + std::string(what) + " index must be in [1, " + std::to_string(count) + "], got " +
                  std::string(text));
    return static_cast<int>(value) - 1;
  }

  Corner corner(std::string_view word) {
    const std::size_t slash = word.find('/');
    Corner c{index(word.substr(0, slash), model_.mesh.positions.size(), "vertex"), Vec2::Zero()};
    if (slash == std::string_view::npos) return c;
    std::string_view texture = word.substr(slash + 1);
    texture = texture.substr(0, texture.find('/'));
    if (texture.empty()) return c;
    any_uv_ = true;
    c.uv = texture_points_[index(texture, texture_points_.size(), "texture")];
    return c;
  }

  void face() {
    if (lines_.values() < 3) lines_.fail("f must have at least 3 corners, got " + std::to_string(lines_.values()));
    if (current_ < 0) {
      model_.materials.push_back({"default", {180, 180, 180}});
      current_ = static_cast<int>(model_.materials.size()) - 1;
    }
    const Corner first = corner(lines_.word(1));
    for (std::size_t i = 2; i < lines_.values(); ++i) {
      const Corner b = corner(lines_.word(i)), c = corner(lines_.word(i + 1));
      model_.mesh.triangles.push_back({first.position, b.position, c.position});
      model_.material.push_back(current_);
      model_.uv.insert(model_.uv.end(), {first.uv, b.uv, c.uv});
    }
  }

  fs::path path_;
  Lines lines_;
  Model model_;
  std::vector<Vec2> texture_points_;
  int current_ = -1;
  bool any_uv_ = false;
};

std::string text_of(double value) {
  char buffer[32];
  return std::string(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

void write_obj(std::ostream& out, const Model& model) {
  out << "mtllib model.mtl\n";
  for (const Vec3& p : model.mesh.positions)
    out << "v " << text_of(p.x()) << ' ' << text_of(p.y()) << ' ' << text_of(p.z()) << '\n';
  for (const Vec2& p : model.uv) out << "vt " << text_of(p.x()) << ' ' << text_of(p.y()) << '\n';
  int current = -1;
  for (std::size_t i = 0; i < model.mesh.triangles.size(); ++i) {
    if (model.material[i] != current) out << "usemtl " << model.materials[current = model.material[i]].name << '\n';
    out << 'f';
    for (std::size_t k = 0; k < 3; ++k) {
      out << ' ' << model.mesh.triangles[i][k] + 1;
      if (!model.uv.empty()) out << '/' << 3 * i + k + 1;
    }
    out << '\n';
  }
}

void write_materials(std::ostream& out, const Model& model) {
  for (std::size_t i = 0; i < model.materials.size(); ++i) {
    const Material& m = model.materials[i];
    out << "newmtl " << m.name << "\nKd " << text_of(m.colour.r / 255.0) << ' ' << text_of(m.colour.g / 255.0) << ' '
        << text_of(m.colour.b / 255.0) << '\n';
    if (!m.texture.empty()) out << "map_Kd texture" << i << ".png\n";
  }
}

}  // namespace

Model load_model(const fs::path& path) { return ObjReader(path).read(); }

void write_model(const fs::path& folder, const Model& model) {
  for (std::size_t i = 0; i < model.materials.size(); ++i)
    if (!model.materials[i].texture.empty())
      write_png(folder / ("texture" + std::to_string(i) + ".png"), model.materials[i].texture);
  write_file(folder / "model.mtl", [&](std::ostream& out) { write_materials(out, model); });
  write_file(folder / "model.obj", [&](std::ostream& out) { write_obj(out, model); });
}

}  // namespace carve
