#include "carve/mesh/formats.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <ostream>
#include <stdexcept>

#include "carve/mesh/adjacency.h"
#include "carve/mesh/topology.h"

namespace carve::formats {

static_assert(std::endian::native == std::endian::little, "Sink::raw and the binary readers assume it");

void Sink::number(double value) {
  char digits[32];
  text({digits, std::to_chars(digits, digits + sizeof digits, value).ptr});
}

void Sink::number(int value) {
  char digits[16];
  text({digits, std::to_chars(digits, digits + sizeof digits, value).ptr});
}

void Sink::flush() {
  out_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  buffer_.clear();
}

std::string ends_at(const std::string& element, std::size_t index, std::size_t count) {
  return "the file ends before " + element + " " + std::to_string(index) + " of " + std::to_string(count);
}

std::string excerpt(std::string_view text, std::size_t longest) {
  std::string shown(text.substr(0, longest));
  for (char& c : shown)
    if (c < ' ' || c > '~') c = '?';
  return "'" + shown + (text.size() > longest ? "...'" : "'");
}

float to_float(double value, const char* format) {
  const float rounded = static_cast<float>(value);
  if (!std::isfinite(rounded))
    throw std::invalid_argument(std::string("coordinates must fit into a float to be written as ") + format);
  return rounded;
}

void check_writable(const std::string& path, const Mesh& mesh, const WriteOptions& options) try {
  if (!options.strict) return check_mesh(mesh);
  const Topology found = topology(mesh);
  if (found.solid()) return;
  std::string faults;
  const auto add = [&](std::int64_t count, const char* one, const char* many) {
    if (count > 0) faults += (faults.empty() ? "" : ", ") + std::to_string(count) + " " + (count == 1 ? one : many);
  };
  add(found.boundary_edges, "boundary edge", "boundary edges");
  add(found.nonmanifold_edges, "edge of more than two triangles", "edges of more than two triangles");
  add(found.misoriented_edges, "misoriented edge", "misoriented edges");
  add(found.nonmanifold_vertices, "nonmanifold vertex", "nonmanifold vertices");
  if (found.triangles == 0) faults = "no triangles";
  throw std::invalid_argument("the mesh must be closed, oriented and 2-manifold, got " + faults);
} catch (const std::invalid_argument& error) {
  throw std::invalid_argument(path + ": " + error.what());
}

}  // namespace carve::formats
