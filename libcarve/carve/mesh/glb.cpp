#include <Eigen/Geometry>
#include <limits>
#include <nlohmann/json.hpp>
#include <ostream>
#include <stdexcept>

#include "carve/mesh/formats.h"

namespace carve::formats {
namespace {

using Json = nlohmann::ordered_json;
using Vec3f = Eigen::Vector3f;

constexpr std::uint32_t kMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;
constexpr int kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126, kVertices = 34962, kIndices = 34963;

Vec3f to_file(const Vec3& p) { return {to_float(p.x(), "GLB"), to_float(p.y(), "GLB"), to_float(p.z(), "GLB")}; }

// Unit normals, the mean of the triangles around each vertex weighted by their areas.
std::vector<Vec3f> vertex_normals(const Mesh& mesh) {
  std::vector<Vec3> sums(mesh.positions.size(), Vec3::Zero());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3& origin = mesh.positions[a];
    const Vec3 cross = (mesh.positions[b] - origin).cross(mesh.positions[c] - origin);
    for (const int v : {a, b, c}) sums[v] += cross;
  }
  std::vector<Vec3f> normals(sums.size());
  for (std::size_t v = 0; v < sums.size(); ++v) {
    const Vec3 unit = sums[v].stableNormalized();
    // Where the triangles cancel out, any unit vector will do; glTF forbids zero.
    normals[v] = unit.squaredNorm() > 0.5 ? Vec3f(unit.cast<float>()) : Vec3f(Vec3f::UnitY());
  }
  return normals;
}

Json numbers(const Vec3f& v) { return Json::array({double(v.x()), double(v.y()), double(v.z())}); }

struct Layout {
  std::size_t vertices, indices, index_size;
  std::size_t vector_bytes() const { return 12 * vertices; }
  std::size_t index_bytes() const { return index_size * indices; }
  std::size_t bytes() const { return (2 * vector_bytes() + index_bytes() + 3) / 4 * 4; }
};

std::string describe(const Layout& layout, const Vec3f& low, const Vec3f& high) {
  Json json;
  json["asset"] = {{"version", "2.0"}, {"generator", "carve"}};
  json["scene"] = 0;
  json["scenes"] = {{{"nodes", {0}}}};
  json["nodes"] = {{{"mesh", 0}}};
  const Json attributes = {{"POSITION", 0}, {"NORMAL", 1}};
  const Json primitive = {{"attributes", attributes}, {"indices", 2}, {"material", 0}};
  json["meshes"] = {{{"primitives", Json::array({primitive})}}};
  json["materials"] = {{{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}}}};
  json["accessors"] = {{{"bufferView", 0},
                        {"componentType", kFloat},
                        {"count", layout.vertices},
                        {"type", "VEC3"},
                        {"min", numbers(low)},
                        {"max", numbers(high)}},
                       {{"bufferView", 1}, {"componentType", kFloat}, {"count", layout.vertices}, {"type", "VEC3"}},
                       {{"bufferView", 2},
                        {"componentType", layout.index_size == 2 ? kUnsignedShort : kUnsignedInt},
                        {"count", layout.indices},
                        {"type", "SCALAR"}}};
  const auto view = [&](std::size_t begin, std::size_t length, int target) {
    return Json{{"buffer", 0}, {"byteOffset", begin}, {"byteLength", length}, {"target", target}};
  };
  json["bufferViews"] = {view(0, layout.vector_bytes(), kVertices),
                         view(layout.vector_bytes(), layout.vector_bytes(), kVertices),
                         view(2 * layout.vector_bytes(), layout.index_bytes(), kIndices)};
  json["buffers"] = {{{"byteLength", layout.bytes()}}};
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  return text;
}

bool is_degenerate(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

void write_header(Sink& sink, const std::string& json, std::size_t binary) {
  const std::size_t length = 12 + 8 + json.size() + 8 + binary;
  if (length > std::numeric_limits<std::uint32_t>::max())
    throw std::invalid_argument("a GLB file holds at most 4294967295 bytes, the mesh needs " + std::to_string(length));
  for (const std::size_t word : {std::size_t{kMagic}, std::size_t{2}, length, json.size(), std::size_t{kJsonChunk}})
    sink.raw(static_cast<std::uint32_t>(word));
  sink.text(json);
  sink.raw(static_cast<std::uint32_t>(binary));
  sink.raw(kBinaryChunk);
}

}  // namespace

void write_glb(std::ostream& out, const Mesh& mesh) {
  std::size_t triangles = 0;
  for (const Triangle& triangle : mesh.triangles) triangles += !is_degenerate(triangle);
  if (triangles == 0) throw std::invalid_argument("a GLB file must hold a triangle, the mesh has none");
  Vec3f low = to_file(mesh.positions[0]), high = low;
  for (const Vec3& position : mesh.positions) {
    low = low.cwiseMin(to_file(position));
    high = high.cwiseMax(to_file(position));
  }
  // 65535 restarts a strip, so it is not an index.
  const std::size_t index_size = mesh.positions.size() <= 65535 ? 2 : 4;
  const Layout layout{mesh.positions.size(), 3 * triangles, index_size};

  Sink sink(out);
  write_header(sink, describe(layout, low, high), layout.bytes());
  for (const Vec3& position : mesh.positions) sink.raw(to_file(position));
  for (const Vec3f& normal : vertex_normals(mesh)) sink.raw(normal);
  for (const Triangle& triangle : mesh.triangles) {
    if (is_degenerate(triangle)) continue;
    for (const int i : triangle) {
      if (index_size == 2)
        sink.raw(static_cast<std::uint16_t>(i));
      else
        sink.raw(static_cast<std::uint32_t>(i));
    }
  }
  sink.text(std::string(layout.bytes() - 2 * layout.vector_bytes() - layout.index_bytes(), '\0'));
}

}  // namespace carve::formats
