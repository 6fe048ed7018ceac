#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>

#include "carve/image/read_image.h"
#include "carve/mesh/formats.h"

namespace carve::formats {
namespace {

constexpr std::uint32_t kMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;
constexpr std::size_t kLongestJson = std::size_t{1} << 26;  // parsed, it takes many times its size
using Json = nlohmann::json;
enum Component { kUnsignedByte = 5121, kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126 };

template <class T>
T load(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

// A typed view of the binary chunk; every element of it lies inside the chunk.
struct Accessor {
  std::string_view bytes;
  std::size_t begin = 0, stride = 0, count = 0;
  int component = 0;
};

// A GLB file whose values are never copied or printed whole: a hostile file nests them deeper than the stack.
class GlbFile {
 public:
  /// \throws IoError  as all members; Json::exception where the JSON lacks a member or has another type
  GlbFile(const std::string& path, std::string_view bytes);

  [[noreturn]] void fail(const std::string& why) const { throw IoError(path_, why); }
  const Json& json() const { return json_; }
  std::size_t size() const { return bytes_.size(); }
  std::size_t whole(const Json& value, const char* name) const;
  std::size_t member(const Json& object, const char* key, std::optional<std::size_t> otherwise = {}) const;
  const Json& list(const Json& object, const char* key) const;  // empty where there is none
  const Json& item(const char* array, std::size_t index) const;
  Accessor accessor(std::size_t index, const std::string& type) const;  // SCALAR, VEC2 or VEC3
  std::string_view view(std::size_t index) const;                       // a bufferView's bytes

 private:
  void read_chunks();

  const std::string& path_;
  std::string_view bytes_, binary_;
  Json json_;
};

GlbFile::GlbFile(const std::string& path, std::string_view bytes) : path_(path), bytes_(bytes) { read_chunks(); }

void GlbFile::read_chunks() {
  if (bytes_.size() < 20 || load<std::uint32_t>(bytes_, 0) != kMagic) fail("is not a GLB file");
  if (load<std::uint32_t>(bytes_, 4) != 2)
    fail("the glTF version must be 2, got " + std::to_string(load<std::uint32_t>(bytes_, 4)));
  const std::size_t length = load<std::uint32_t>(bytes_, 8);
  if (length != bytes_.size())
    fail("declares " + std::to_string(length) + " bytes, got " + std::to_string(bytes_.size()));
  std::string_view text;
  for (std::size_t at = 12; at < bytes_.size();) {
    if (bytes_.size() - at < 8) fail("the file ends inside a chunk's header");
    const std::size_t size = load<std::uint32_t>(bytes_, at);
    const std::uint32_t kind = load<std::uint32_t>(bytes_, at + 4);
    at += 8;
    if (size > bytes_.size() - at)
      fail("a chunk declares " + std::to_string(size) + " bytes, the file has " + std::to_string(bytes_.size() - at) +
           " left");
    if (kind == kJsonChunk && size > kLongestJson)
      fail("the JSON chunk must have at most " + std::to_string(kLongestJson) + " bytes, got " + std::to_string(size));
    if (kind == kJsonChunk && text.empty()) text = bytes_.substr(at, size);
    if (kind == kBinaryChunk && binary_.empty()) binary_ = bytes_.substr(at, size);
    at += size;
  }
  try {
    json_ = Json::parse(text);
  } catch (const Json::exception& error) {
    fail("glTF JSON: " + excerpt(error.what(), 160));
  }
  if (!json_.is_object()) fail("glTF JSON: must be an object");
}

std::size_t GlbFile::whole(const Json& value, const char* name) const {
  if (!value.is_number_unsigned())
    fail(std::string(name) + " must be a whole number from 0, got " +
         (value.is_number() ? value.dump() : value.type_name()));
  return value.get<std::size_t>();
}
std::size_t GlbFile::member(const Json& object, const char* key, std::optional<std::size_t> otherwise) const {
  return otherwise && !object.contains(key) ? *otherwise : whole(object.at(key), key);
}

const Json& GlbFile::list(const Json& object, const char* key) const {
  static const Json none = Json::array();
  if (!object.contains(key)) return none;
  if (!object.at(key).is_array()) fail(std::string(key) + " must be an array, got " + object.at(key).type_name());
  return object.at(key);
}

const Json& GlbFile::item(const char* array, std::size_t index) const {
  const Json& items = list(json_, array);
  if (index >= items.size()) fail(std::string(array) + "[" + std::to_string(index) + "] does not exist");
  return items[index];
}

Accessor GlbFile::accessor(std::size_t index, const std::string& type) const {
  const std::string name = "accessors[" + std::to_string(index) + "]";
  const Json& json = item("accessors", index);
  if (json.at("type").get<std::string>() != type) fail(name + " must be of type " + type);
  if (!json.contains("bufferView") || json.contains("sparse"))
    fail(name + " is sparse or compressed, which is not supported");
  const Json& view = item("bufferViews", member(json, "bufferView"));
  const std::size_t buffer = member(view, "buffer");
  if (buffer != 0 || item("buffers", buffer).contains("uri"))
    fail(name + " lies outside the file's binary chunk, which is not supported");
  const int component = static_cast<int>(member(json, "componentType"));
  const std::size_t size = component == kUnsignedByte                         ? 1
                           : component == kUnsignedShort                      ? 2
                           : component == kUnsignedInt || component == kFloat ? 4
                                                                              : 0;
  if (size == 0 || (type == "SCALAR" && component == kFloat))
    fail(name + ": componentType " + std::to_string(component) + " is not supported");
  const std::size_t element = size * (type == "VEC3" ? 3 : type == "VEC2" ? 2 : 1);
  Accessor result{binary_, member(json, "byteOffset", 0), member(view, "byteStride", element), member(json, "count"),
                  component};
  const std::size_t view_begin = member(view, "byteOffset", 0), view_size = member(view, "byteLength");
  const bool inside = view_begin <= binary_.size() && view_size <= binary_.size() - view_begin &&
                      result.begin <= view_size && result.stride >= element && result.stride <= 252 + element;
  const std::size_t room = inside ? view_size - result.begin : 0;
  if (!inside || (result.count > 0 && (element > room || result.count - 1 > (room - element) / result.stride)))
    fail(name + ": " + std::to_string(result.count) + " elements do not fit into its bufferView and the file");
  result.begin += view_begin;
  return result;
}

std::string_view GlbFile::view(std::size_t index) const {
  const Json& view = item("bufferViews", index);
  const std::size_t begin = member(view, "byteOffset", 0), size = member(view, "byteLength");
  if (member(view, "buffer") != 0 || begin > binary_.size() || size > binary_.size() - begin)
    fail("bufferViews[" + std::to_string(index) + "] does not lie in the file");
  return binary_.substr(begin, size);
}

// What a scene may have. Its nodes can show one mesh often, so the file's size does not bound it.
constexpr std::size_t kMost = std::size_t{1} << 26;  // vertices or triangles, unless the file itself holds more
constexpr std::size_t kMostPrimitives = std::size_t{1} << 20;
enum Mode { kTriangles = 4, kStrip = 5, kFan = 6 };

class GlbReader : GlbFile {
 public:
  GlbReader(const std::string& path, std::string_view bytes, bool textured)
      : GlbFile(path, bytes), path_(path), textured_(textured) {}

  TexturedMesh read() {
    try {
      refuse_extensions();
      visited_.resize(list(json(), "nodes").size());
      for (const std::size_t root : roots()) walk(root);
      check_size();
      for (const auto& [primitive, place] : placed_) read_primitive(*primitive, place);
      if (textured_) read_picture();
    } catch (const Json::exception& error) {
      fail("glTF JSON: " + excerpt(error.what(), 160));
    }
    return std::move(result_);
  }

 private:
  // Extensions without which the geometry would be read wrong.
  void refuse_extensions() const {
    for (const Json& extension : list(json(), "extensionsRequired")) {
      const std::string name = extension.get<std::string>();
      if (name == "KHR_draco_mesh_compression" || name == "EXT_meshopt_compression" || name == "KHR_mesh_quantization")
        fail("needs the glTF extension " + name + ", which is not supported");
    }
  }

  // The nodes of the scene, or without scenes all that are no other node's children.
  std::vector<std::size_t> roots() const {
    std::vector<std::size_t> all;
    if (json().contains("scenes")) {
      for (const Json& node : list(item("scenes", member(json(), "scene", 0)), "nodes"))
        all.push_back(whole(node, "a scene's node"));
      return all;
    }
    std::vector<bool> is_child(visited_.size());
    for (const Json& node : list(json(), "nodes"))
      for (const Json& child : list(node, "children")) {
        const std::size_t index = whole(child, "a node's child");
        if (index < is_child.size()) is_child[index] = true;
      }
    for (std::size_t i = 0; i < is_child.size(); ++i)
      if (!is_child[i]) all.push_back(i);
    return all;
  }

  // Lists the primitives below a node.
  void walk(std::size_t root) {
    std::vector<std::pair<std::size_t, Eigen::Affine3d>> open{{root, Eigen::Affine3d::Identity()}};
    while (!open.empty()) {
      const auto [index, above] = open.back();
      open.pop_back();
      const Json& node = item("nodes", index);
      if (visited_[index]) fail("nodes[" + std::to_string(index) + "] has two parents");
      visited_[index] = true;
      const Eigen::Affine3d place = above * transform(node);
      if (node.contains("mesh"))
        for (const Json& primitive : list(item("meshes", member(node, "mesh")), "primitives"))
          place_primitive(primitive, place);
      const Json& children = list(node, "children");
      for (auto child = children.rbegin(); child != children.rend(); ++child)
        open.emplace_back(whole(*child, "a node's child"), place);
    }
  }

  void place_primitive(const Json& primitive, const Eigen::Affine3d& place) {
    if (++primitives_ > kMostPrimitives)
      fail("the scene must have at most " + std::to_string(kMostPrimitives) + " primitives");
    const std::size_t mode = member(primitive, "mode", kTriangles);
    if (mode > kFan) fail("a primitive's mode must be in [0, 6], got " + std::to_string(mode));
    const bool has_triangles = mode >= kTriangles && primitive.at("attributes").contains("POSITION");
    if (has_triangles) placed_.emplace_back(&primitive, place);
  }

  // Before memory is filled.
  void check_size() {
    const std::size_t most = std::max(kMost, size() / sizeof(Triangle));
    std::size_t vertices = 0, corners = 0;
    for (const auto& [primitive, place] : placed_) {
      const std::size_t count = positions(*primitive).count;
      vertices += count;
      corners += primitive->contains("indices") ? indices(*primitive).count : count;
      if (vertices > most || corners > 3 * most)
        fail("the scene must have at most " + std::to_string(most) + " vertices or triangles");
    }
    mesh_.positions.reserve(vertices);
    mesh_.triangles.reserve(corners / 3);
  }

  Accessor positions(const Json& primitive) const {
    const Accessor result = accessor(member(primitive.at("attributes"), "POSITION"), "VEC3");
    if (result.component != kFloat) fail("POSITION must be of floats");
    return result;
  }
  Accessor indices(const Json& primitive) const { return accessor(member(primitive, "indices"), "SCALAR"); }

  Eigen::Affine3d transform(const Json& node) const {
    Eigen::Affine3d place = Eigen::Affine3d::Identity();
    if (node.contains("matrix")) {
      const auto m = node.at("matrix").get<std::array<double, 16>>();
      place.matrix() = Eigen::Map<const Eigen::Matrix4d>(m.data());
      return place;
    }
    const auto t = node.value("translation", std::array<double, 3>{0, 0, 0});
    const auto r = node.value("rotation", std::array<double, 4>{0, 0, 0, 1});
    const auto s = node.value("scale", std::array<double, 3>{1, 1, 1});
    place.translate(Vec3(t[0], t[1], t[2]));
    place.rotate(Eigen::Quaterniond(r[3], r[0], r[1], r[2]));
    place.scale(Vec3(s[0], s[1], s[2]));
    return place;
  }

  void read_primitive(const Json& primitive, const Eigen::Affine3d& place) {
    const Accessor positions = this->positions(primitive);
    const int base = static_cast<int>(mesh_.positions.size());
    for (std::size_t i = 0; i < positions.count; ++i) {
      const std::size_t at = positions.begin + i * positions.stride;
      const Vec3 local(load<float>(positions.bytes, at), load<float>(positions.bytes, at + 4),
                       load<float>(positions.bytes, at + 8));
      const Vec3 world = place * local;
      if (!world.allFinite()) fail("POSITION " + std::to_string(i) + " must be finite");
      mesh_.positions.push_back(world);
    }
    std::vector<int> corners = this->corners(primitive, positions.count);
    const auto mode = static_cast<Mode>(member(primitive, "mode", kTriangles));
    const bool mirrored = place.linear().determinant() < 0;
    if (textured_) {
      // Texture coordinates are numbered as the file's vertices, so its corners are theirs too.
      const int first = read_uvs(primitive, positions.count);
      add_triangles(corners, mode, first, mirrored, result_.uv_triangles);
    }
    if (primitive.at("attributes").contains("TEXCOORD_0")) merge_equal(base, corners);
    add_triangles(corners, mode, base, mirrored, mesh_.triangles);
  }

  int read_uvs(const Json& primitive, std::size_t vertices) {
    if (!primitive.at("attributes").contains("TEXCOORD_0")) fail("every primitive must have texture coordinates");
    const Accessor uvs = accessor(member(primitive.at("attributes"), "TEXCOORD_0"), "VEC2");
    if (uvs.component != kFloat || uvs.count != vertices) fail("TEXCOORD_0 must be of floats, one a vertex");
    const int first = static_cast<int>(result_.uvs.size());
    for (std::size_t i = 0; i < uvs.count; ++i) {
      const std::size_t at = uvs.begin + i * uvs.stride;
      result_.uvs.emplace_back(load<float>(uvs.bytes, at), load<float>(uvs.bytes, at + 4));
      if (!result_.uvs.back().allFinite()) fail("TEXCOORD_0 " + std::to_string(i) + " must be finite");
    }
    return first;
  }

  // The one picture that all primitives' materials have as their base colour.
  void read_picture() {
    std::vector<std::size_t> images;
    for (const auto& [primitive, place] : placed_) {
      const Json& surface = item("materials", member(*primitive, "material")).at("pbrMetallicRoughness");
      const Json& texture = item("textures", member(surface.at("baseColorTexture"), "index"));
      images.push_back(member(texture, "source"));
      if (images.back() != images.front()) fail("has more than one picture, which is not supported");
    }
    if (images.empty()) fail("has no triangles");
    const Json& image = item("images", images.front());
    if (!image.contains("bufferView")) fail("its picture lies outside the file, which is not supported");
    result_.texture = decode_image(std::string(view(member(image, "bufferView"))), path_);
  }

  // Joins what texture coordinates have split: of the vertices from `base` on at one position only the first stays.
  void merge_equal(int base, std::vector<int>& corners) {
    const auto less = [](const Vec3& a, const Vec3& b) {
      return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
    };
    const int count = static_cast<int>(mesh_.positions.size()) - base;
    std::vector<int> order(count), merged(count);
    std::iota(order.begin(), order.end(), base);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return less(mesh_.positions[a], mesh_.positions[b]); });
    std::vector<int> same(count);  // the first vertex of this position
    for (int i = 0; i < count; ++i)
      same[order[i] - base] =
          i > 0 && mesh_.positions[order[i]] == mesh_.positions[order[i - 1]] ? same[order[i - 1] - base] : order[i];
    int kept = 0;
    for (int i = 0; i < count; ++i) {
      merged[i] = same[i] == base + i ? kept++ : merged[same[i] - base];
      mesh_.positions[base + merged[i]] = mesh_.positions[base + i];
    }
    mesh_.positions.resize(base + kept);
    for (int& corner : corners) corner = merged[corner];
  }

  std::vector<int> corners(const Json& primitive, std::size_t vertices) const {
    std::vector<int> all;
    if (!primitive.contains("indices")) {
      for (std::size_t i = 0; i < vertices; ++i) all.push_back(static_cast<int>(i));
      return all;
    }
    const Accessor indices = this->indices(primitive);
    all.reserve(indices.count);
    for (std::size_t i = 0; i < indices.count; ++i) {
      const std::size_t at = indices.begin + i * indices.stride;
      const std::size_t index = indices.component == kUnsignedByte    ? load<std::uint8_t>(indices.bytes, at)
                                : indices.component == kUnsignedShort ? load<std::uint16_t>(indices.bytes, at)
                                                                      : load<std::uint32_t>(indices.bytes, at);
      if (index >= vertices)
        fail("index " + std::to_string(i) + " must be in [0, " + std::to_string(vertices) + "), got " +
             std::to_string(index));
      all.push_back(static_cast<int>(index));
    }
    return all;
  }

  void add_triangles(const std::vector<int>& corners, Mode mode, int base, bool mirrored,
                     std::vector<Triangle>& to) const {
    if (mode == kTriangles && corners.size() % 3 != 0)
      fail("the number of indices must be a multiple of 3, got " + std::to_string(corners.size()));
    const std::size_t step = mode == kTriangles ? 3 : 1;
    for (std::size_t i = 0; i + 2 < corners.size(); i += step) {
      Triangle t{corners[mode == kFan ? 0 : i], corners[i + 1], corners[i + 2]};
      if ((mode == kStrip && i % 2 == 1) != mirrored) std::swap(t[1], t[2]);
      for (int& corner : t) corner += base;
      to.push_back(t);
    }
  }

  const std::string& path_;
  bool textured_;
  std::vector<bool> visited_;  // nodes
  std::size_t primitives_ = 0;
  std::vector<std::pair<const Json*, Eigen::Affine3d>> placed_ = {};  // the scene's primitives of triangles
  TexturedMesh result_;
  Mesh& mesh_ = result_.mesh;
};

}  // namespace

Mesh read_glb(const std::string& path, std::string_view bytes) { return GlbReader(path, bytes, false).read().mesh; }

TexturedMesh read_textured_glb(const std::string& path, std::string_view bytes) {
  return GlbReader(path, bytes, true).read();
}

}  // namespace carve::formats
