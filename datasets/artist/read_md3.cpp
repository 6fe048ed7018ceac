#include <map>
#include <sstream>

#include "artist/bytes.h"
#include "artist/readers.h"
#include "carve/core/file.h"

namespace carve::artist {
namespace {

constexpr std::int64_t kNameLength = 64, kTagSize = 112, kVertexSize = 8;

Vec3 vector_at(const Bytes& file, std::int64_t at) {
  const Vec3 v(file.get<float>(at), file.get<float>(at + 4), file.get<float>(at + 8));
  if (!v.allFinite()) file.fail("a number is not finite");
  return v;
}

void append_surface(const Bytes& file, std::int64_t at, int frame, Model& model) {
  const auto header = [&](int field) { return std::int64_t{file.get<std::int32_t>(at + 68 + 4 * field)}; };
  const std::int64_t frames = header(1), vertices = header(3), triangles = header(4);
  const std::int64_t triangle_at = at + header(5), texcoord_at = at + header(7);
  if (frame >= frames) file.fail("a surface has no frame " + std::to_string(frame));
  const std::int64_t vertex_at = at + header(8) + frame * std::max<std::int64_t>(vertices, 0) * kVertexSize;
  file.check(vertex_at, vertices, kVertexSize, "vertices");
  file.check(texcoord_at, vertices, 8, "texture coordinates");
  file.check(triangle_at, triangles, 12, "triangles");
  const int first = static_cast<int>(model.positions.size());
  for (std::int64_t v = 0; v < vertices; ++v) {
    const auto coordinate = [&](int i) { return file.get<std::int16_t>(vertex_at + kVertexSize * v + 2 * i) / 64.0; };
    model.positions.push_back({coordinate(0), coordinate(1), coordinate(2)});
    model.texcoords.push_back({file.get<float>(texcoord_at + 8 * v), 1 - file.get<float>(texcoord_at + 8 * v + 4)});
  }
  for (std::int64_t t = 0; t < triangles; ++t) {
    Face face{{}, static_cast<int>(model.materials.size())};
    for (int k = 0; k < 3; ++k) {
      const int index = file.get<std::int32_t>(triangle_at + 12 * t + 4 * k);
      if (index < 0 || index >= vertices) file.fail("a triangle has a corner that is not there");
      face.corners[2 - k] = {first + index, first + index};  // Quake's triangles are clockwise
    }
    model.faces.push_back(face);
  }
  model.materials.push_back({file.text(at + 4, kNameLength)});
}

// Surface name -> texture file, from lines "surface,models/players/x/texture.tga".
std::map<std::string, std::string> read_skin(const std::filesystem::path& path) {
  std::map<std::string, std::string> skin;
  std::istringstream lines(read_file(path));
  for (std::string line; std::getline(lines, line);) {
    const auto comma = line.find(',');
    if (comma == std::string::npos) continue;
    std::string texture = line.substr(comma + 1);
    texture.erase(texture.find_last_not_of(" \r") + 1);
    skin[line.substr(0, comma)] = std::filesystem::path(texture).filename().string();
  }
  return skin;
}

}  // namespace

Md3 read_md3(std::string_view data, const std::string& name, int frame) {
  const Bytes file(data, name);
  if (file.text(0, 4) != "IDP3" || file.get<std::int32_t>(4) != 15) file.fail("not an MD3 file of version 15");
  const std::int64_t frames = file.get<std::int32_t>(76), tags = file.get<std::int32_t>(80);
  const std::int64_t surfaces = file.get<std::int32_t>(84), tag_at = file.get<std::int32_t>(96);
  if (frame < 0 || frame >= frames) file.fail("it has no frame " + std::to_string(frame));
  Md3 md3;
  file.check(tag_at, tags, kTagSize, "tags");
  file.check(tag_at + frame * tags * kTagSize, tags, kTagSize, "tags");
  for (std::int64_t t = 0; t < tags; ++t) {
    const std::int64_t at = tag_at + (frame * tags + t) * kTagSize;
    Md3::Tag tag{file.text(at, kNameLength), vector_at(file, at + kNameLength), {}};
    for (int i = 0; i < 3; ++i) tag.axes.col(i) = vector_at(file, at + kNameLength + 12 + 12 * i).normalized();
    md3.tags.push_back(tag);
  }
  std::int64_t at = file.get<std::int32_t>(100);
  for (std::int64_t s = 0; s < surfaces; ++s) {
    append_surface(file, at, frame, md3.model);
    const std::int64_t size = file.get<std::int32_t>(at + 104);
    if (size <= 0) file.fail("surface " + std::to_string(s) + " has no end");
    at += size;
  }
  return md3;
}

Model read_player(const std::filesystem::path& folder, std::array<int, 3> frames) {
  const std::array<std::string, 3> parts = {"lower", "upper", "head"}, joints = {"tag_torso", "tag_head", ""};
  Model player;
  Vec3 origin = Vec3::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  for (int part = 0; part < 3; ++part) {
    const std::filesystem::path path = folder / (parts[part] + ".md3");
    const Md3 md3 = read_md3(read_file(path), path.string(), frames[part]);
    const auto skin = read_skin(folder / (parts[part] + "_default.skin"));
    const int first = static_cast<int>(player.positions.size()), material = static_cast<int>(player.materials.size());
    for (const Vec3& p : md3.model.positions) player.positions.push_back(axes * p + origin);
    player.texcoords.insert(player.texcoords.end(), md3.model.texcoords.begin(), md3.model.texcoords.end());
    for (Face face : md3.model.faces) {
      for (Corner& c : face.corners) c = {c.position + first, c.texcoord + first};
      face.material += material;
      player.faces.push_back(face);
    }
    for (Material m : md3.model.materials) {
      if (const auto found = skin.find(m.name); found != skin.end()) m.texture = found->second;
      player.materials.push_back(m);
    }
    if (joints[part].empty()) continue;
    const auto tag = std::find_if(md3.tags.begin(), md3.tags.end(), [&](auto& t) { return t.name == joints[part]; });
    if (tag == md3.tags.end()) throw IoError(path.string(), "it has no tag " + joints[part]);
    origin = axes * tag->origin + origin;
    axes = axes * tag->axes;
  }
  return player;
}

}  // namespace carve::artist
