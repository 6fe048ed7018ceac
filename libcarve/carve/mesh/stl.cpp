#include <Eigen/Geometry>
#include <array>
#include <bit>
#include <ostream>

#include "carve/mesh/formats.h"
#include "carve/mesh/text_reader.h"

namespace carve::formats {
namespace {

constexpr std::size_t kHeader = 80, kFacet = 50;
using Corner = std::array<float, 3>;  // in the file's axes: Z up, front towards -Y

// Adding zero turns -0 into 0, so that equal corners have equal bytes.
Corner to_file(const Vec3& p) {
  return {to_float(p.x(), "STL") + 0.0f, to_float(-p.z(), "STL") + 0.0f, to_float(p.y(), "STL") + 0.0f};
}
Vec3 from_file(const Vec3& p) { return {p.x() + 0.0, p.z() + 0.0, -p.y() + 0.0}; }
Eigen::Vector3f vector(const Corner& c) { return {c[0], c[1], c[2]}; }

std::array<Corner, 3> corners_of(const Mesh& mesh, const Triangle& t) {
  return {to_file(mesh.positions[t[0]]), to_file(mesh.positions[t[1]]), to_file(mesh.positions[t[2]])};
}

// Rounding to floats can bring corners together; leaving such facets out keeps a closed surface closed.
bool collapsed(const std::array<Corner, 3>& c) { return c[0] == c[1] || c[1] == c[2] || c[2] == c[0]; }

// Gives equal corners one index, in order of first appearance.
class CornerMerger {
 public:
  CornerMerger(std::vector<Vec3>& positions, std::size_t expected)
      : positions_(positions), slots_(std::bit_ceil(2 * expected + 1024), kFree) {}

  int index(const Vec3& position) {
    if (2 * positions_.size() >= slots_.size()) grow();
    std::size_t slot = hash(position);
    for (; slots_[slot] != kFree; slot = (slot + 1) & (slots_.size() - 1))
      if (positions_[slots_[slot]] == position) return slots_[slot];
    slots_[slot] = static_cast<int>(positions_.size());
    positions_.push_back(position);
    return slots_[slot];
  }

 private:
  static constexpr int kFree = -1;

  std::size_t hash(const Vec3& position) const {
    std::uint64_t bits = 0;
    for (const double x : position) {
      bits = (bits ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15u;
      bits ^= bits >> 32;
    }
    return bits & (slots_.size() - 1);
  }

  void grow() {
    slots_.assign(4 * slots_.size(), kFree);
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      std::size_t slot = hash(positions_[i]);
      while (slots_[slot] != kFree) slot = (slot + 1) & (slots_.size() - 1);
      slots_[slot] = static_cast<int>(i);
    }
  }

  std::vector<Vec3>& positions_;
  std::vector<int> slots_;  // a power of two, at most half full
};

Mesh read_binary(const std::string& path, std::string_view bytes) {
  std::uint32_t count = 0;
  if (bytes.size() < kHeader + sizeof count)
    throw IoError(path, "an STL file has at least 84 bytes, got " + std::to_string(bytes.size()));
  std::memcpy(&count, bytes.data() + kHeader, sizeof count);
  const std::size_t wanted = kHeader + sizeof count + kFacet * std::size_t{count};
  if (bytes.size() != wanted)
    throw IoError(path, "declares " + std::to_string(count) + " triangles, which is " + std::to_string(wanted) +
                            " bytes, got " + std::to_string(bytes.size()));
  Mesh mesh;
  mesh.triangles.reserve(count);
  CornerMerger merger(mesh.positions, count / 2);  // a closed surface has half as many vertices as triangles
  for (std::size_t facet = 0; facet < count; ++facet) {
    std::array<Corner, 4> normal_and_corners;
    std::memcpy(&normal_and_corners, bytes.data() + kHeader + sizeof count + kFacet * facet, sizeof normal_and_corners);
    Triangle triangle;
    for (int i = 0; i < 3; ++i) {
      const Corner& corner = normal_and_corners[i + 1];
      if (!vector(corner).allFinite())
        throw IoError(path, "triangle " + std::to_string(facet) + ": a coordinate must be finite");
      triangle[i] = merger.index(from_file(vector(corner).cast<double>()));
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

bool is_word(std::string_view word, std::string_view lower) {
  const auto same = [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; };
  return std::equal(word.begin(), word.end(), lower.begin(), lower.end(), same);
}

Mesh read_text(const std::string& path, std::string_view bytes) {
  TextReader text(path, bytes, false);
  Mesh mesh;
  CornerMerger merger(mesh.positions, 0);
  Triangle triangle;
  std::size_t corners = 0;
  bool in_solid = false;
  while (text.next_line()) {
    const std::string_view word = text.word();
    if (is_word(word, "vertex")) {
      const double x = text.coordinate(), y = text.coordinate(), z = text.coordinate();
      if (corners < 3) triangle[corners] = merger.index(from_file({x, y, z}));
      ++corners;
    } else if (is_word(word, "facet")) {
      corners = 0;
    } else if (is_word(word, "endfacet")) {
      if (corners != 3) text.fail("a facet must have 3 vertices, got " + std::to_string(corners));
      mesh.triangles.push_back(triangle);
      corners = 0;
    } else if (is_word(word, "solid") || is_word(word, "endsolid")) {
      in_solid = is_word(word, "solid");
    } else if (!is_word(word, "outer") && !is_word(word, "endloop")) {
      text.fail("must be solid, facet, outer loop, vertex or the end of one, got " + excerpt(word));
    }
  }
  if (in_solid || corners > 0) text.fail("the file ends before its endsolid");
  return mesh;
}

}  // namespace

void write_stl(std::ostream& out, const Mesh& mesh) {
  std::uint32_t count = 0;
  for (const Triangle& triangle : mesh.triangles) count += !collapsed(corners_of(mesh, triangle));
  Sink sink(out);
  std::string header = "carve: Z up, front towards -Y, object units";  // must not begin with "solid"
  header.resize(kHeader, ' ');
  sink.text(header);
  sink.raw(count);
  for (const Triangle& triangle : mesh.triangles) {
    const std::array<Corner, 3> c = corners_of(mesh, triangle);
    if (collapsed(c)) continue;
    const Vec3& a = mesh.positions[triangle[0]];
    const Vec3 cross = (mesh.positions[triangle[1]] - a).cross(mesh.positions[triangle[2]] - a);
    const Corner normal = to_file(cross.stableNormalized());
    sink.raw(normal);
    for (const Corner& corner : c) sink.raw(corner);
    sink.raw(std::uint16_t{0});
  }
}

Mesh read_stl(const std::string& path, std::string_view bytes) {
  // Binary headers may begin with "solid" too; a size that fits the count to the byte tells them.
  std::uint32_t count = 0;
  if (bytes.size() >= kHeader + sizeof count) std::memcpy(&count, bytes.data() + kHeader, sizeof count);
  const bool fits = bytes.size() == kHeader + sizeof count + kFacet * std::size_t{count};
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  const bool text = first != std::string_view::npos && is_word(bytes.substr(first, 5), "solid") &&
                    bytes.substr(0, 4096).find('\0') == std::string_view::npos;
  return text && !fits ? read_text(path, bytes) : read_binary(path, bytes);
}

}  // namespace carve::formats
