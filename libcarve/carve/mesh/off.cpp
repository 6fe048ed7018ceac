#include <charconv>
#include <limits>
#include <ostream>

#include "carve/mesh/formats.h"
#include "carve/mesh/text_reader.h"

namespace carve::formats {
namespace {

// The keyword may have prefixes for what follows each position, which we skip: COFF, NOFF, STOFF, CNOFF. Some files
// have the counts on its line, or the first of them in its word; returns what follows the keyword there.
std::string_view read_keyword(TextReader& text) {
  if (!text.next_line()) text.fail("an OFF file must begin with OFF, got nothing");
  const std::string_view word = text.word();
  const std::size_t at = word.find("OFF");
  if (at == std::string_view::npos || word.substr(0, at).find_first_not_of("STCN") != std::string_view::npos)
    text.fail("an OFF file must begin with OFF, got " + excerpt(word));
  const std::string_view rest = word.substr(at + 3);
  return rest.empty() ? text.word() : rest;
}

// A count that the rest of the file can hold. \param shortest bytes of one such line
std::size_t count(TextReader& text, const char* what, std::string_view word, std::size_t shortest) {
  long long value = -1;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool whole = error == std::errc() && stop == word.data() + word.size();
  const std::size_t most = std::min<std::size_t>(std::numeric_limits<int>::max(), text.bytes_left() / shortest + 1);
  if (!whole || value < 0 || static_cast<unsigned long long>(value) > most)
    text.fail("the number of " + std::string(what) + " must be in [0, " + std::to_string(most) +
              "], as many as the file can hold, got " + excerpt(word));
  return static_cast<std::size_t>(value);
}

}  // namespace

void write_off(std::ostream& out, const Mesh& mesh) {
  Sink sink(out);
  sink.text("OFF\n# carve: Y up, front towards +Z, object units\n");
  sink.number(static_cast<int>(mesh.positions.size()));
  sink.text(" ");
  sink.number(static_cast<int>(mesh.triangles.size()));
  sink.text(" 0\n");
  for (const Vec3& p : mesh.positions)
    for (int i = 0; i < 3; ++i) sink.number(p[i]), sink.text(i < 2 ? " " : "\n");
  for (const Triangle& t : mesh.triangles) {
    sink.text("3");
    for (const int i : t) sink.text(" "), sink.number(i);
    sink.text("\n");
  }
}

Mesh read_off(const std::string& path, std::string_view bytes) {
  TextReader text(path, bytes);
  std::string_view word = read_keyword(text);
  if (word.empty() && text.next_line()) word = text.word();
  const std::size_t vertices = count(text, "vertices", word, 6), faces = count(text, "faces", text.word(), 8);

  Mesh mesh;
  mesh.positions.reserve(vertices);
  for (std::size_t v = 0; v < vertices; ++v) {
    if (!text.next_line()) text.fail(ends_at("vertex", v, vertices));
    const double x = text.coordinate(), y = text.coordinate(), z = text.coordinate();
    mesh.positions.emplace_back(x, y, z);
  }
  mesh.triangles.reserve(faces);
  std::vector<int> corners;
  for (std::size_t f = 0; f < faces; ++f) {
    if (!text.next_line()) text.fail(ends_at("face", f, faces));
    const long long size = text.whole("a face's number of corners");
    if (size < 3) text.fail("a face must have at least 3 corners, got " + std::to_string(size));
    corners.clear();
    for (long long i = 0; i < size; ++i) {
      const long long index = text.whole("a face's corner");
      if (index < 0 || static_cast<std::size_t>(index) >= vertices)
        text.fail("a face's corner must be in [0, " + std::to_string(vertices) + "), got " + std::to_string(index));
      corners.push_back(static_cast<int>(index));
    }
    add_polygon(mesh, corners);
  }
  return mesh;
}

}  // namespace carve::formats
