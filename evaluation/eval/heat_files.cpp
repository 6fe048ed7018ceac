#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <ostream>
#include <stdexcept>

#include "carve/core/file.h"
#include "carve/image/read_image.h"
#include "eval/heat_map.h"

namespace carve {
namespace {

// Values one after another, little endian.
class Bytes {
 public:
  template <class T>
  void add(T value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    if constexpr (std::endian::native == std::endian::big) std::reverse(raw, raw + sizeof value);
    text_.append(raw, sizeof value);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

void add(Bytes& bytes, Rgba c) {
  bytes.add(c.r);
  bytes.add(c.g);
  bytes.add(c.b);
}

// An array of the appended section: its XML element, and its bytes behind their count.
void append(std::string& xml, std::string& data, const std::string& attributes, const Bytes& bytes) {
  xml += "        <DataArray " + attributes + " format=\"appended\" offset=\"" + std::to_string(data.size()) + "\"/>\n";
  Bytes count;
  count.add(static_cast<std::uint64_t>(bytes.text().size()));
  data += count.text() + bytes.text();
}

}  // namespace

void write_heat_ply(const std::filesystem::path& path, const HeatMap& map, Ramp ramp, double range) {
  Bytes body;
  for (std::size_t i = 0; i < map.mesh.positions.size(); ++i) {
    for (int k = 0; k < 3; ++k) body.add(map.mesh.positions[i][k]);
    body.add(static_cast<float>(map.distances[i]));
    body.add(static_cast<float>(map.distances[i]));
    add(body, colour(ramp, map.distances[i], range));
  }
  for (const Triangle& triangle : map.mesh.triangles) {
    body.add(std::uint8_t{3});
    for (const int corner : triangle) body.add(static_cast<std::int32_t>(corner));
  }
  write_file(path, [&](std::ostream& out) {
    out << "ply\nformat binary_little_endian 1.0\n"
        << "comment signed distance to the reference, positive outside\n"
        << "element vertex " << map.mesh.positions.size() << "\n"
        << "property double x\nproperty double y\nproperty double z\n"
        << "property float quality\nproperty float scalar_C2M\n"
        << "property uchar red\nproperty uchar green\nproperty uchar blue\n"
        << "element face " << map.mesh.triangles.size() << "\nproperty list uchar int vertex_indices\nend_header\n"
        << body.text();
  });
}

void write_heat_vtp(const std::filesystem::path& path, const HeatMap& map, Ramp ramp, double range) {
  Bytes points, distances, colours, connectivity, offsets;
  for (std::size_t i = 0; i < map.mesh.positions.size(); ++i) {
    for (int k = 0; k < 3; ++k) points.add(map.mesh.positions[i][k]);
    distances.add(map.distances[i]);
    add(colours, colour(ramp, map.distances[i], range));
  }
  // A cloud is shown as vertices.
  const bool cloud = map.mesh.triangles.empty();
  const std::size_t cells = cloud ? map.mesh.positions.size() : map.mesh.triangles.size();
  for (std::size_t i = 0; i < cells; ++i) {
    if (cloud)
      connectivity.add(static_cast<std::int64_t>(i));
    else
      for (const int corner : map.mesh.triangles[i]) connectivity.add(static_cast<std::int64_t>(corner));
    offsets.add(static_cast<std::int64_t>((i + 1) * (cloud ? 1 : 3)));
  }
  std::string xml, data;
  xml += "      <PointData Scalars=\"C2M\">\n";
  append(xml, data, "type=\"Float64\" Name=\"C2M\"", distances);
  append(xml, data, "type=\"UInt8\" Name=\"colour\" NumberOfComponents=\"3\"", colours);
  xml += "      </PointData>\n      <Points>\n";
  append(xml, data, "type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"", points);
  const std::string kind = cloud ? "Verts" : "Polys";
  xml += "      </Points>\n      <" + kind + ">\n";
  append(xml, data, "type=\"Int64\" Name=\"connectivity\"", connectivity);
  append(xml, data, "type=\"Int64\" Name=\"offsets\"", offsets);
  xml += "      </" + kind + ">\n";
  write_file(path, [&](std::ostream& out) {
    out << "<?xml version=\"1.0\"?>\n"
        << "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
        << "  <PolyData>\n    <Piece NumberOfPoints=\"" << map.mesh.positions.size() << "\" NumberOfVerts=\""
        << (cloud ? cells : 0) << "\" NumberOfPolys=\"" << (cloud ? 0 : cells) << "\">\n"
        << xml << "    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n_" << data
        << "\n  </AppendedData>\n</VTKFile>\n";
  });
}

void check_heat_output(const std::filesystem::path& path, std::size_t maps) {
  const std::string ending = path.extension().string();
  if (ending != ".png" && ending != ".ply" && ending != ".vtp")
    throw std::invalid_argument(path.string() + ": the output must end in .png, .ply or .vtp");
  if (ending != ".png" && maps != 1)
    throw std::invalid_argument(path.string() + ": holds one compared mesh, got " + std::to_string(maps));
}

void write_heat_maps(const std::filesystem::path& path, const std::vector<HeatMap>& maps, const Mesh& reference,
                     double diagonal, const HeatMapOptions& options) {
  check_heat_output(path, maps.size());
  const double range = heat_range(maps, diagonal, options);
  if (path.extension() == ".png")
    write_png(path, draw_heat_maps(maps, reference, diagonal, options));
  else if (path.extension() == ".ply")
    write_heat_ply(path, maps[0], options.ramp, range);
  else
    write_heat_vtp(path, maps[0], options.ramp, range);
}

}  // namespace carve
