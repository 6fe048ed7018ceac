#include "carve/mesh/ply.h"

#include <ostream>
#include <set>
#include <stdexcept>

#include "carve/core/file.h"
#include "carve/mesh/formats.h"

namespace carve {

void formats::write_ply(std::ostream& out, const Mesh& mesh, std::span<const VertexProperty> properties) {
  Sink sink(out);
  sink.text("ply\nformat binary_little_endian 1.0\ncomment carve: Y up, front towards +Z, object units\n");
  sink.text("element vertex " + std::to_string(mesh.positions.size()) + "\n");
  sink.text("property double x\nproperty double y\nproperty double z\n");
  for (const VertexProperty& property : properties)
    sink.text((property.values.index() == 0 ? "property float " : "property uchar ") + property.name + "\n");
  sink.text("element face " + std::to_string(mesh.triangles.size()) + "\n");
  sink.text("property list uchar int vertex_indices\nend_header\n");
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    for (const double x : mesh.positions[v]) sink.raw(x);
    for (const VertexProperty& property : properties)
      std::visit([&](const auto& values) { sink.raw(values[v]); }, property.values);
  }
  for (const Triangle& triangle : mesh.triangles) {
    sink.raw(std::uint8_t{3});
    sink.raw(triangle);
  }
}

namespace {

void check_properties(std::span<const VertexProperty> properties, std::size_t vertices) {
  constexpr const char* kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
  std::set<std::string> names{"", "x", "y", "z"};
  for (const VertexProperty& property : properties) {
    if (property.name.find_first_not_of(kLetters) != std::string::npos || !names.insert(property.name).second)
      throw std::invalid_argument(
          "a vertex property's name must be letters, digits and underscores, not x, y or z and not there twice, got " +
          formats::excerpt(property.name));
    const std::size_t size = std::visit([](const auto& values) { return values.size(); }, property.values);
    if (size != vertices)
      throw std::invalid_argument("vertex property " + property.name + " must have a value for each of the " +
                                  std::to_string(vertices) + " vertices, got " + std::to_string(size));
  }
}

}  // namespace

void write_ply(const std::filesystem::path& path, const Mesh& mesh, std::span<const VertexProperty> properties,
               const WriteOptions& options) {
  check_properties(properties, mesh.positions.size());
  formats::check_writable(path.string(), mesh, options);
  write_file(path, [&](std::ostream& out) { formats::write_ply(out, mesh, properties); });
}

}  // namespace carve
