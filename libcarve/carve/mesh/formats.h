#pragma once
// What the mesh formats share; not part of the interface.
#include <cstring>
#include <iosfwd>
#include <span>
#include <string>
#include <string_view>

#include "carve/core/error.h"
#include "carve/mesh/mesh_io.h"
#include "carve/mesh/ply.h"

namespace carve::formats {

void write_ply(std::ostream& out, const Mesh& mesh, std::span<const VertexProperty> properties);
void write_obj(std::ostream& out, const Mesh& mesh);
void write_off(std::ostream& out, const Mesh& mesh);
void write_stl(std::ostream& out, const Mesh& mesh);
void write_glb(std::ostream& out, const Mesh& mesh);
void write_textured_glb(std::ostream& out, const TexturedMesh& textured);
/// \param material  the file that says which picture `texture` is, as named in the OBJ file
void write_textured_obj(std::ostream& out, const TexturedMesh& textured, const std::string& material);

Mesh read_ply(const std::string& path, std::string_view bytes);
Mesh read_obj(const std::string& path, std::string_view bytes);
Mesh read_off(const std::string& path, std::string_view bytes);
Mesh read_stl(const std::string& path, std::string_view bytes);
Mesh read_glb(const std::string& path, std::string_view bytes);
TexturedMesh read_textured_glb(const std::string& path, std::string_view bytes);

/// By the path's ending; what read_mesh does once it has the file.
Mesh read(const std::filesystem::path& path, std::string_view bytes);

/// What every mesh must be before it is written; `path` begins the message. \throws std::invalid_argument
void check_writable(const std::string& path, const Mesh& mesh, const WriteOptions& options);

/// Gathers bytes for a stream in large pieces; numbers as the shortest text that reads back to the same value.
class Sink {
 public:
  explicit Sink(std::ostream& out) : out_(out) { buffer_.reserve(kSize); }
  ~Sink() { flush(); }
  Sink(const Sink&) = delete;
  Sink& operator=(const Sink&) = delete;

  void text(std::string_view text) {
    room(text.size());
    buffer_.append(text);
  }
  void number(double value);
  void number(int value);
  /// As the machine holds it: little endian.
  template <class T>
  void raw(const T& value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    room(sizeof(T));
    buffer_.append(bytes, sizeof(T));
  }

 private:
  static constexpr std::size_t kSize = 1 << 18;
  void room(std::size_t size) {
    if (buffer_.size() + size > kSize) flush();
  }
  void flush();

  std::ostream& out_;
  std::string buffer_;
};

/// For messages: "the file ends before vertex 7 of 12".
std::string ends_at(const std::string& element, std::size_t index, std::size_t count);

/// For messages: a piece of a file, printable and short, in quotes.
std::string excerpt(std::string_view text, std::size_t longest = 40);

/// The triangles of the polygon's fan. \param corners indices; at least three
template <class Corners>
void add_polygon(Mesh& mesh, const Corners& corners) {
  for (std::size_t i = 2; i < corners.size(); ++i) mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
}

/// Any coordinate as a float. \throws std::invalid_argument if it is too large for one
float to_float(double value, const char* format);

}  // namespace carve::formats
