#include <charconv>
#include <limits>
#include <ostream>

#include "carve/mesh/formats.h"
#include "carve/mesh/text_reader.h"

namespace carve::formats {
namespace {

class ObjReader {
 public:
  ObjReader(const std::string& path, std::string_view text) : path_(path), text_(path, text) {}

  Mesh read() {
    while (text_.next_line()) {
      const std::string_view keyword = text_.word();
      if (keyword == "v")
        read_vertex();
      else if (keyword == "f")
        read_face();
    }
    if (highest_ > mesh_.positions.size())
      throw IoError(path_ + ":" + std::to_string(highest_line_), "a face's corner must index one of " +
                                                                     std::to_string(mesh_.positions.size()) +
                                                                     " vertices, got " + std::to_string(highest_));
    return std::move(mesh_);
  }

 private:
  void read_vertex() {
    Vec3 position;
    for (double& x : position) x = text_.coordinate();
    mesh_.positions.push_back(position);
  }

  void read_face() {
    corners_.clear();
    for (std::string_view word = text_.word(); !word.empty(); word = text_.word()) corners_.push_back(corner(word));
    if (corners_.size() < 3) text_.fail("a face must have at least 3 corners, got " + std::to_string(corners_.size()));
    add_polygon(mesh_, corners_);
  }

  // "7", "7/1", "7//3", "7/1/3": the position's index; negative ones count back from the last vertex so far.
  int corner(std::string_view word) {
    long long parts[3] = {};
    const char *at = word.data(), *const end = word.data() + word.size();
    for (int i = 0; i < 3; ++i) {
      const auto [stop, error] = std::from_chars(at, end, parts[i]);
      const bool empty_texture = i == 1 && stop == at && stop < end && *stop == '/';
      if (error != std::errc() && !empty_texture) break;
      at = stop;
      if (at == end) break;
      if (*at != '/' || i == 2) break;
      ++at;
    }
    if (at != end || at[-1] == '/')
      text_.fail("a face's corner must be v, v/vt, v//vn or v/vt/vn, got " + excerpt(word));
    const long long vertices = static_cast<long long>(mesh_.positions.size());
    const long long index = parts[0] < 0 ? vertices + parts[0] + 1 : parts[0];
    if (index < 1 || index > std::numeric_limits<int>::max())
      text_.fail("a face's corner must index one of " + std::to_string(vertices) + " vertices, got " +
                 std::to_string(parts[0]));
    // A face may stand before its vertices: the end of the file tells.
    if (static_cast<std::size_t>(index) > highest_) {
      highest_ = static_cast<std::size_t>(index);
      highest_line_ = text_.line();
    }
    return static_cast<int>(index - 1);
  }

  const std::string& path_;
  TextReader text_;
  Mesh mesh_;
  std::vector<int> corners_;
  std::size_t highest_ = 0;  // from 1
  long long highest_line_ = 0;
};

}  // namespace

namespace {
void write_positions(Sink& sink, const Mesh& mesh) {
  sink.text("# carve: Y up, front towards +Z; object units (the longest side is 1 unless a size was given)\n");
  for (const Vec3& p : mesh.positions) {
    sink.text("v");
    for (const double x : p) sink.text(" "), sink.number(x);
    sink.text("\n");
  }
}
}  // namespace

void write_textured_obj(std::ostream& out, const TexturedMesh& textured, const std::string& material) {
  Sink sink(out);
  write_positions(sink, textured.mesh);
  sink.text("mtllib " + material + "\nusemtl texture\n");
  for (const Vec2& uv : textured.uvs) {
    sink.text("vt "), sink.number(uv.x()), sink.text(" ");
    sink.number(1 - uv.y()), sink.text("\n");
  }
  for (std::size_t t = 0; t < textured.mesh.triangles.size(); ++t) {
    sink.text("f");
    for (int k = 0; k < 3; ++k) {
      sink.text(" "), sink.number(textured.mesh.triangles[t][k] + 1);
      sink.text("/"), sink.number(textured.uv_triangles[t][k] + 1);
    }
    sink.text("\n");
  }
}

void write_obj(std::ostream& out, const Mesh& mesh) {
  Sink sink(out);
  write_positions(sink, mesh);
  for (const Triangle& t : mesh.triangles) {
    sink.text("f");
    for (const int i : t) sink.text(" "), sink.number(i + 1);
    sink.text("\n");
  }
}

Mesh read_obj(const std::string& path, std::string_view bytes) { return ObjReader(path, bytes).read(); }

}  // namespace carve::formats
