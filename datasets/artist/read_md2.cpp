#include "artist/bytes.h"
#include "artist/readers.h"

namespace carve::artist {

Model read_md2(std::string_view data, const std::string& name) {
  const Bytes file(data, name);
  if (file.text(0, 4) != "IDP2" || file.get<std::int32_t>(4) != 8) file.fail("not an MD2 file of version 8");
  const auto header = [&](int field) { return std::int64_t{file.get<std::int32_t>(4 * field)}; };
  const std::int64_t width = header(2), height = header(3), frame_size = header(4), vertices = header(6);
  const std::int64_t texcoords = header(7), triangles = header(8), frames = header(10);
  const std::int64_t texcoord_at = header(12), triangle_at = header(13), frame_at = header(14);
  if (width <= 0 || height <= 0) file.fail("its skin has no size");
  if (frames < 1 || frame_size < 40 + 4 * vertices) file.fail("its frames hold no vertices");
  file.check(texcoord_at, texcoords, 4, "texture coordinates");
  file.check(triangle_at, triangles, 12, "triangles");
  file.check(frame_at, 1, frame_size, "frames");
  file.check(frame_at + 40, vertices, 4, "vertices");

  Model model;
  model.materials.push_back({"skin"});
  const auto frame_vector = [&](int offset) {  // the frame's scale, then its translation
    const std::int64_t at = frame_at + offset;
    return Vec3(file.get<float>(at), file.get<float>(at + 4), file.get<float>(at + 8));
  };
  for (std::int64_t v = 0; v < vertices; ++v) {
    const std::int64_t at = frame_at + 40 + 4 * v;
    const Vec3 packed(file.get<std::uint8_t>(at), file.get<std::uint8_t>(at + 1), file.get<std::uint8_t>(at + 2));
    model.positions.push_back(frame_vector(0).cwiseProduct(packed) + frame_vector(12));
    if (!model.positions.back().allFinite()) file.fail("a vertex is not finite");
  }
  for (std::int64_t t = 0; t < texcoords; ++t) {
    const double s = file.get<std::int16_t>(texcoord_at + 4 * t), v = file.get<std::int16_t>(texcoord_at + 4 * t + 2);
    model.texcoords.push_back({s / static_cast<double>(width), 1 - v / static_cast<double>(height)});
  }
  for (std::int64_t t = 0; t < triangles; ++t) {
    Face face;
    for (int k = 0; k < 3; ++k) {
      const std::int64_t at = triangle_at + 12 * t + 2 * k;
      const int position = file.get<std::uint16_t>(at), texcoord = file.get<std::uint16_t>(at + 6);
      if (position >= vertices || texcoord >= texcoords)
        file.fail("triangle " + std::to_string(t) + " has a corner that is not there");
      face.corners[2 - k] = {position, texcoord};  // Quake's triangles are clockwise
    }
    model.faces.push_back(face);
  }
  return model;
}

}  // namespace carve::artist
