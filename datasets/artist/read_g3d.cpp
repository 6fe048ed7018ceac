#include "artist/bytes.h"
#include "artist/readers.h"

namespace carve::artist {
namespace {

constexpr std::int64_t kNameLength = 64;

// Appends one of the file's meshes; returns where the next one starts.
std::int64_t append_mesh(const Bytes& file, std::int64_t at, Model& model) {
  Material material{file.text(at, kNameLength)};
  at += kNameLength;
  const std::int64_t frames = file.get<std::uint32_t>(at), vertices = file.get<std::uint32_t>(at + 4);
  const std::int64_t indices = file.get<std::uint32_t>(at + 8);
  material.colour = Vec3(file.get<float>(at + 12), file.get<float>(at + 16), file.get<float>(at + 20));
  const std::uint32_t textures = file.get<std::uint32_t>(at + 48);
  at += 52;
  if (frames < 1) file.fail("a mesh has no frame");
  if (indices % 3 != 0) file.fail("a mesh's indices are no triangles");
  for (int bit = 0; bit < 32; ++bit) {
    if (!(textures >> bit & 1)) continue;
    const std::string texture = file.text(at, kNameLength);
    if (bit == 0) material.texture = texture;  // the others are gloss and normal maps
    at += kNameLength;
  }
  file.check(at, frames, 1, "frames");
  file.check(at, vertices, 24, "vertices");
  file.check(at, frames * vertices, 24, "vertices and normals");
  const int first = static_cast<int>(model.positions.size()), first_texcoord = static_cast<int>(model.texcoords.size());
  for (std::int64_t v = 0; v < vertices; ++v) {
    model.positions.push_back(
        {file.get<float>(at + 12 * v), file.get<float>(at + 12 * v + 4), file.get<float>(at + 12 * v + 8)});
    if (!model.positions.back().allFinite()) file.fail("a vertex is not finite");
  }
  at += frames * vertices * 24;
  if (textures != 0) {
    file.check(at, vertices, 8, "texture coordinates");
    for (std::int64_t v = 0; v < vertices; ++v)
      model.texcoords.push_back({file.get<float>(at + 8 * v), file.get<float>(at + 8 * v + 4)});
    at += vertices * 8;
  }
  file.check(at, indices, 4, "indices");
  for (std::int64_t i = 0; i < indices; i += 3) {
    Face face{{}, static_cast<int>(model.materials.size())};
    for (int k = 0; k < 3; ++k) {
      const std::int64_t index = file.get<std::uint32_t>(at + 4 * (i + k));
      if (index >= vertices) file.fail("a triangle has a corner that is not there");
      face.corners[k] = {first + static_cast<int>(index),
                         textures != 0 ? first_texcoord + static_cast<int>(index) : -1};
    }
    model.faces.push_back(face);
  }
  model.materials.push_back(material);
  return at + indices * 4;
}

}  // namespace

Model read_g3d(std::string_view data, const std::string& name) {
  const Bytes file(data, name);
  if (file.text(0, 3) != "G3D" || file.get<std::uint8_t>(3) != 4) file.fail("not a G3D file of version 4");
  Model model;
  std::int64_t at = 7;
  for (int mesh = file.get<std::uint16_t>(4); mesh > 0; --mesh) at = append_mesh(file, at, model);
  return model;
}

}  // namespace carve::artist
