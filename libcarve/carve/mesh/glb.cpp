#include <Eigen/Geometry>
#include <limits>
#include <nlohmann/json.hpp>
#include <ostream>
#include <stdexcept>

#include "carve/image/read_image.h"
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

// What a file holds: vertices, along seams one a texture coordinate, and a picture.
struct Content {
  std::vector<Vec3f> positions, normals;
  std::vector<Eigen::Vector2f> uvs;  // as many, or none
  std::vector<int> indices;
  std::string png;
};

class Layout {
 public:
  explicit Layout(const Content& content) : vertices(content.positions.size()), indices(content.indices.size()) {
    // 65535 restarts a strip, so it is not an index.
    index_size = vertices <= 65535 ? 2 : 4;
    const bool textured = !content.uvs.empty();
    add(12 * vertices, kVertices), add(12 * vertices, kVertices);
    if (textured) add(8 * vertices, kVertices);
    add(index_size * indices, kIndices);
    if (textured) add(content.png.size(), 0);
  }

  struct View {
    std::size_t begin, length;
    int target;  // 0 = neither vertices nor indices
  };
  std::size_t vertices, indices, index_size;
  std::vector<View> views;
  std::size_t bytes = 0;

 private:
  void add(std::size_t length, int target) {
    views.push_back({bytes, length, target});
    bytes = (bytes + length + 3) / 4 * 4;
  }
};

Json accessors(const Layout& layout, const Content& content) {
  Vec3f low = content.positions[0], high = low;
  for (const Vec3f& position : content.positions) low = low.cwiseMin(position), high = high.cwiseMax(position);
  const auto vertices = [&](int view, const char* type) {
    return Json{{"bufferView", view}, {"componentType", kFloat}, {"count", layout.vertices}, {"type", type}};
  };
  Json all = {vertices(0, "VEC3"), vertices(1, "VEC3")};
  all[0]["min"] = numbers(low);
  all[0]["max"] = numbers(high);
  if (!content.uvs.empty()) all.push_back(vertices(2, "VEC2"));
  all.push_back({{"bufferView", all.size()},
                 {"componentType", layout.index_size == 2 ? kUnsignedShort : kUnsignedInt},
                 {"count", layout.indices},
                 {"type", "SCALAR"}});
  return all;
}

std::string describe(const Layout& layout, const Content& content) {
  const bool textured = !content.uvs.empty();
  Json json;
  json["asset"] = {{"version", "2.0"}, {"generator", "carve"}};
  json["scene"] = 0;
  json["scenes"] = {{{"nodes", {0}}}};
  json["nodes"] = {{{"mesh", 0}}};
  Json attributes = {{"POSITION", 0}, {"NORMAL", 1}};
  if (textured) attributes["TEXCOORD_0"] = 2;
  const Json primitive = {{"attributes", attributes}, {"indices", textured ? 3 : 2}, {"material", 0}};
  json["meshes"] = {{{"primitives", Json::array({primitive})}}};
  Json surface = {{"metallicFactor", 0}, {"roughnessFactor", 1}};
  if (textured) {
    surface["baseColorTexture"] = {{"index", 0}};
    json["textures"] = {{{"source", 0}, {"sampler", 0}}};
    json["images"] = {{{"bufferView", 4}, {"mimeType", "image/png"}}};
    constexpr int kLinear = 9729, kLinearMipmapLinear = 9987, kClamp = 33071;
    json["samplers"] = {
        {{"magFilter", kLinear}, {"minFilter", kLinearMipmapLinear}, {"wrapS", kClamp}, {"wrapT", kClamp}}};
  }
  json["materials"] = {{{"pbrMetallicRoughness", surface}}};
  json["accessors"] = accessors(layout, content);
  for (const auto& [begin, length, target] : layout.views) {
    Json view = {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", length}};
    if (target) view["target"] = target;
    json["bufferViews"].push_back(view);
  }
  json["buffers"] = {{{"byteLength", layout.bytes}}};
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

void write(std::ostream& out, const Content& content) {
  if (content.indices.empty()) throw std::invalid_argument("a GLB file must hold a triangle, the mesh has none");
  const Layout layout(content);
  Sink sink(out);
  write_header(sink, describe(layout, content), layout.bytes);
  const auto pad = [&](std::size_t written) {
    for (; written % 4 != 0; ++written) sink.raw('\0');
  };
  for (const Vec3f& position : content.positions) sink.raw(position);
  for (const Vec3f& normal : content.normals) sink.raw(normal);
  for (const Eigen::Vector2f& uv : content.uvs) sink.raw(uv);
  for (const int i : content.indices) {
    if (layout.index_size == 2)
      sink.raw(static_cast<std::uint16_t>(i));
    else
      sink.raw(static_cast<std::uint32_t>(i));
  }
  pad(layout.index_size * layout.indices);
  sink.text(content.png);
  pad(content.png.size());
}

}  // namespace

void write_glb(std::ostream& out, const Mesh& mesh) {
  Content content;
  for (const Vec3& position : mesh.positions) content.positions.push_back(to_file(position));
  content.normals = vertex_normals(mesh);
  for (const Triangle& triangle : mesh.triangles)
    if (!is_degenerate(triangle)) content.indices.insert(content.indices.end(), triangle.begin(), triangle.end());
  write(out, content);
}

void write_textured_glb(std::ostream& out, const TexturedMesh& textured) {
  const std::vector<Vec3f> normals = vertex_normals(textured.mesh);
  Content content;
  content.png = encode_png(textured.texture);
  // A vertex a pair of position and texture coordinate; those of one coordinate mostly have one position.
  std::vector<int> first(textured.uvs.size(), -1), next, position;
  const auto vertex = [&](int p, int uv) {
    int* at = &first[uv];
    while (*at >= 0 && position[*at] != p) at = &next[*at];
    if (*at >= 0) return *at;
    *at = static_cast<int>(position.size());  // before next grows
    const int made = *at;
    position.push_back(p), next.push_back(-1);
    content.positions.push_back(to_file(textured.mesh.positions[p]));
    content.normals.push_back(normals[p]);
    content.uvs.emplace_back(textured.uvs[uv].cast<float>());
    return made;
  };
  for (std::size_t t = 0; t < textured.mesh.triangles.size(); ++t) {
    const Triangle& triangle = textured.mesh.triangles[t];
    if (is_degenerate(triangle)) continue;
    for (int k = 0; k < 3; ++k) content.indices.push_back(vertex(triangle[k], textured.uv_triangles[t][k]));
  }
  write(out, content);
}

}  // namespace carve::formats
