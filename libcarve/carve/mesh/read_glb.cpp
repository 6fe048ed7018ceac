#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "carve/mesh/formats.h"

namespace carve::formats {
namespace {

using Json = nlohmann::json;

constexpr std::uint32_t kMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;
enum Component { kUnsignedByte = 5121, kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126 };
enum Mode { kTriangles = 4, kStrip = 5, kFan = 6 };

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

class GlbReader {
 public:
  GlbReader(const std::string& path, std::string_view bytes) : path_(path), bytes_(bytes) {}

  Mesh read() {
    read_chunks();
    try {
      refuse_extensions();
      for (const std::size_t root : roots()) read_tree(root);
    } catch (const Json::exception& error) {
      fail(std::string("glTF JSON: ") + error.what());
    }
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& why) const { throw IoError(path_, why); }

  void read_chunks() {
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
      if (kind == kJsonChunk && text.empty()) text = bytes_.substr(at, size);
      if (kind == kBinaryChunk && binary_.empty()) binary_ = bytes_.substr(at, size);
      at += size;
    }
    try {
      json_ = Json::parse(text);
    } catch (const Json::exception& error) {
      fail(std::string("glTF JSON: ") + error.what());
    }
    if (!json_.is_object()) fail("glTF JSON: must be an object");
  }

  // Extensions without which the geometry would be read wrong.
  void refuse_extensions() const {
    if (!json_.contains("extensionsRequired")) return;
    for (const Json& extension : json_.at("extensionsRequired")) {
      const std::string name = extension.get<std::string>();
      if (name == "KHR_draco_mesh_compression" || name == "EXT_meshopt_compression" || name == "KHR_mesh_quantization")
        fail("needs the glTF extension " + name + ", which is not supported");
    }
  }

  // A whole number from 0, or the default where there is none.
  std::size_t whole(const Json& object, const char* key, std::optional<std::size_t> otherwise = {}) const {
    if (otherwise && !object.contains(key)) return *otherwise;
    const Json& value = object.at(key);
    if (!value.is_number_unsigned())
      fail(std::string(key) + " must be a whole number from 0, got " + excerpt(value.dump()));
    return value.get<std::size_t>();
  }

  const Json& item(const char* array, std::size_t index) const {
    const Json& items = json_.at(array);
    if (!items.is_array() || index >= items.size())
      fail(std::string(array) + "[" + std::to_string(index) + "] does not exist");
    return items[index];
  }

  // The nodes of the scene, or without scenes all that are no other node's children.
  std::vector<std::size_t> roots() const {
    std::vector<std::size_t> all;
    if (json_.contains("scenes")) {
      const Json& scene = item("scenes", whole(json_, "scene", 0));
      for (const Json& node : scene.value("nodes", Json::array())) all.push_back(node.get<std::size_t>());
      return all;
    }
    const Json nodes = json_.value("nodes", Json::array());
    std::vector<bool> is_child(nodes.size());
    for (const Json& node : nodes)
      for (const Json& child : node.value("children", Json::array()))
        if (child.get<std::size_t>() < nodes.size()) is_child[child.get<std::size_t>()] = true;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (!is_child[i]) all.push_back(i);
    return all;
  }

  void read_tree(std::size_t root) {
    std::vector<std::pair<std::size_t, Eigen::Affine3d>> open{{root, Eigen::Affine3d::Identity()}};
    while (!open.empty()) {
      const auto [index, above] = open.back();
      open.pop_back();
      const Json& node = item("nodes", index);
      visited_.resize(json_.at("nodes").size());
      if (visited_[index]) fail("nodes[" + std::to_string(index) + "] has two parents");
      visited_[index] = true;
      const Eigen::Affine3d place = above * transform(node);
      if (node.contains("mesh")) read_mesh(whole(node, "mesh"), place);
      const Json children = node.value("children", Json::array());
      for (auto child = children.rbegin(); child != children.rend(); ++child)
        open.emplace_back(child->get<std::size_t>(), place);
    }
  }

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

  void read_mesh(std::size_t index, const Eigen::Affine3d& place) {
    for (const Json& primitive : item("meshes", index).at("primitives")) {
      const std::size_t mode = whole(primitive, "mode", kTriangles);
      if (mode < kTriangles) continue;  // points and lines
      if (mode > kFan) fail("a primitive's mode must be in [0, 6], got " + std::to_string(mode));
      read_primitive(primitive, static_cast<Mode>(mode), place);
    }
  }

  void read_primitive(const Json& primitive, Mode mode, const Eigen::Affine3d& place) {
    const Json& attributes = primitive.at("attributes");
    if (!attributes.contains("POSITION")) return;
    const Accessor positions = accessor(whole(attributes, "POSITION"), "VEC3");
    if (positions.component != kFloat) fail("POSITION must be of floats");
    // A file may show one mesh in many places: what is made of it stays within bounds.
    constexpr std::size_t kMost = std::size_t{1} << 27;
    if (mesh_.positions.size() + positions.count > std::max(kMost, bytes_.size()) ||
        mesh_.triangles.size() > std::max(kMost, bytes_.size()))
      fail("the scene has more than " + std::to_string(kMost) + " vertices or triangles");
    const int base = static_cast<int>(mesh_.positions.size());
    for (std::size_t i = 0; i < positions.count; ++i) {
      const std::size_t at = positions.begin + i * positions.stride;
      const Vec3 local(load<float>(positions.bytes, at), load<float>(positions.bytes, at + 4),
                       load<float>(positions.bytes, at + 8));
      const Vec3 world = place * local;
      if (!world.allFinite()) fail("POSITION " + std::to_string(i) + " must be finite");
      mesh_.positions.push_back(world);
    }
    add_triangles(corners(primitive, positions.count), mode, base, place.linear().determinant() < 0);
  }

  std::vector<int> corners(const Json& primitive, std::size_t vertices) const {
    std::vector<int> all;
    if (!primitive.contains("indices")) {
      for (std::size_t i = 0; i < vertices; ++i) all.push_back(static_cast<int>(i));
      return all;
    }
    const Accessor indices = accessor(whole(primitive, "indices"), "SCALAR");
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

  void add_triangles(const std::vector<int>& corners, Mode mode, int base, bool mirrored) {
    if (mode == kTriangles && corners.size() % 3 != 0)
      fail("the number of indices must be a multiple of 3, got " + std::to_string(corners.size()));
    const std::size_t step = mode == kTriangles ? 3 : 1;
    for (std::size_t i = 0; i + 2 < corners.size(); i += step) {
      Triangle t{corners[mode == kFan ? 0 : i], corners[i + 1], corners[i + 2]};
      if ((mode == kStrip && i % 2 == 1) != mirrored) std::swap(t[1], t[2]);
      for (int& corner : t) corner += base;
      mesh_.triangles.push_back(t);
    }
  }

  Accessor accessor(std::size_t index, const std::string& type) const {
    const std::string name = "accessors[" + std::to_string(index) + "]";
    const Json& json = item("accessors", index);
    if (json.at("type").get<std::string>() != type) fail(name + " must be of type " + type);
    if (!json.contains("bufferView") || json.contains("sparse"))
      fail(name + " is sparse or compressed, which is not supported");
    const Json& view = item("bufferViews", whole(json, "bufferView"));
    const std::size_t buffer = whole(view, "buffer");
    if (buffer != 0 || item("buffers", buffer).contains("uri"))
      fail(name + " lies outside the file's binary chunk, which is not supported");
    const int component = static_cast<int>(whole(json, "componentType"));
    const std::size_t size = component == kUnsignedByte                         ? 1
                             : component == kUnsignedShort                      ? 2
                             : component == kUnsignedInt || component == kFloat ? 4
                                                                                : 0;
    if (size == 0 || (type == "SCALAR" && component == kFloat))
      fail(name + ": componentType " + std::to_string(component) + " is not supported");
    const std::size_t element = size * (type == "VEC3" ? 3 : 1);
    Accessor result{binary_, whole(json, "byteOffset", 0), whole(view, "byteStride", element), whole(json, "count"),
                    component};
    const std::size_t view_begin = whole(view, "byteOffset", 0), view_size = whole(view, "byteLength");
    const bool inside = view_begin <= binary_.size() && view_size <= binary_.size() - view_begin &&
                        result.begin <= view_size && result.stride >= element && result.stride <= 252 + element;
    const std::size_t room = inside ? view_size - result.begin : 0;
    if (!inside || (result.count > 0 && (element > room || result.count - 1 > (room - element) / result.stride)))
      fail(name + ": " + std::to_string(result.count) + " elements do not fit into its bufferView and the file");
    result.begin += view_begin;
    return result;
  }

  const std::string& path_;
  std::string_view bytes_, binary_;
  Json json_;
  std::vector<bool> visited_;
  Mesh mesh_;
};

}  // namespace

Mesh read_glb(const std::string& path, std::string_view bytes) { return GlbReader(path, bytes).read(); }

}  // namespace carve::formats
