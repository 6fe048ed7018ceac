#include "carve/photo/point_files.h"

#include <array>
#include <cmath>
#include <cstring>

#include "carve/core/error.h"
#include "carve/core/file.h"
#include "carve/mesh/ply_header.h"

namespace carve {
namespace {
using formats::PlyEncoding;
using formats::PlyProperty;
using formats::PlyType;
using formats::TextReader;

using Numbers = std::array<double, 6>;

void add(OrientedPoints& points, const Numbers& n) {
  const Vec3 normal(n[3], n[4], n[5]);
  const double length = normal.norm();
  if (!(length > 0)) return;
  points.positions.emplace_back(n[0], n[1], n[2]);
  points.normals.push_back(normal / length);
}

// Where in a vertex each of the six numbers stands.
std::array<int, 6> places_of(const std::string& path, const formats::PlyElement& vertex) {
  std::array<int, 6> places{-1, -1, -1, -1, -1, -1};
  constexpr const char* names[] = {"x", "y", "z", "nx", "ny", "nz"};
  for (std::size_t i = 0; i < vertex.properties.size(); ++i) {
    if (vertex.properties[i].count) throw IoError(path, "a vertex with a list is not supported");
    for (int k = 0; k < 6; ++k)
      if (vertex.properties[i].name == names[k]) places[k] = static_cast<int>(i);
  }
  for (int k = 0; k < 6; ++k)
    if (places[k] < 0) throw IoError(path, std::string("element vertex has no property ") + names[k]);
  return places;
}

double binary(const char* bytes, PlyType type) {
  if (type == PlyType::f64) {
    double value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }
  float value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

OrientedPoints read_binary(const std::string& path, std::string_view body, const formats::PlyElement& vertex) {
  const std::array<int, 6> places = places_of(path, vertex);
  std::vector<std::size_t> offsets;
  std::size_t size = 0;
  for (const PlyProperty& property : vertex.properties) {
    offsets.push_back(size);
    size += formats::size_of(property.type);
  }
  for (const int place : places)
    if (!formats::is_real(vertex.properties[place].type)) throw IoError(path, "coordinates must be float or double");
  OrientedPoints points;
  for (std::size_t i = 0; i < vertex.count; ++i) {
    if (body.size() < size * (i + 1)) throw IoError(path, formats::ends_at("vertex", i, vertex.count));
    Numbers n;
    for (int k = 0; k < 6; ++k) {
      n[k] = binary(body.data() + size * i + offsets[places[k]], vertex.properties[places[k]].type);
      if (!std::isfinite(n[k])) throw IoError(path, "vertex " + std::to_string(i) + ": a number is not finite");
    }
    add(points, n);
  }
  return points;
}

OrientedPoints read_text(const std::string& path, TextReader& text, const formats::PlyElement& vertex) {
  const std::array<int, 6> places = places_of(path, vertex);
  OrientedPoints points;
  for (std::size_t i = 0; i < vertex.count; ++i) {
    if (!text.next_line()) throw IoError(path, formats::ends_at("vertex", i, vertex.count));
    std::vector<double> values;
    for (std::size_t p = 0; p < vertex.properties.size(); ++p) values.push_back(text.coordinate());
    Numbers n;
    for (int k = 0; k < 6; ++k) n[k] = values[places[k]];
    add(points, n);
  }
  return points;
}

OrientedPoints read_ply_points(const std::string& path, std::string_view bytes) {
  TextReader text(path, bytes, false);
  const formats::PlyHeader header = formats::read_header(text);
  formats::check_counts(path, header, text.rest().size());
  if (header.elements.empty() || header.elements[0].name != "vertex")
    throw IoError(path, "the first element must be vertex");
  if (header.encoding == PlyEncoding::text) return read_text(path, text, header.elements[0]);
  if (header.encoding == PlyEncoding::big) throw IoError(path, "points in binary_big_endian are not supported");
  return read_binary(path, text.rest(), header.elements[0]);
}

}  // namespace

OrientedPoints read_oriented_points(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  if (path.extension() != ".pset") return read_ply_points(path.string(), bytes);
  TextReader text(path.string(), bytes);
  OrientedPoints points;
  while (text.next_line()) {
    Numbers n;
    for (double& value : n) value = text.coordinate();
    add(points, n);
  }
  return points;
}

OrientedPoints read_colmap_points(const std::filesystem::path& path, std::span<const Photo> photos) {
  const std::string bytes = read_file(path);
  TextReader text(path.string(), bytes);
  std::vector<Vec3> positions, towards;
  while (text.next_line()) {
    text.whole("a point's number");
    Vec3 p, sum = Vec3::Zero();
    for (int k = 0; k < 3; ++k) p[k] = text.coordinate();
    for (int k = 0; k < 4; ++k) text.coordinate();  // colour, error
    while (text.has_word()) {
      const long long image = text.whole("an image's number");
      text.whole("a feature's number");
      if (image < 1 || image > static_cast<long long>(photos.size()))
        text.fail("an image's number must be in [1, " + std::to_string(photos.size()) + "], got " +
                  std::to_string(image));
      sum += (photos[image - 1].camera.centre() - p).normalized();
    }
    positions.push_back(p);
    towards.push_back(sum);
  }
  return with_normals(positions, towards);
}

}  // namespace carve
