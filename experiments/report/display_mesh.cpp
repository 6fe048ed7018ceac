#include "report/display_mesh.h"

#include <meshoptimizer.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace carve::experiments {
namespace {

constexpr int kSteps = 65535;

struct Flat {
  std::vector<float> positions;  // three a vertex
  std::vector<unsigned> indices;
};

Flat simplified(const Mesh& mesh, int triangles) {
  Flat flat;
  for (const Vec3& p : mesh.positions)
    for (int k = 0; k < 3; ++k) flat.positions.push_back(static_cast<float>(p[k]));
  for (const Triangle& t : mesh.triangles)
    for (const int corner : t) flat.indices.push_back(static_cast<unsigned>(corner));
  const std::size_t count = mesh.positions.size(), stride = 3 * sizeof(float), wanted = 3u * triangles;
  constexpr float kAnyError = 1;
  if (flat.indices.size() > wanted) {
    std::vector<unsigned> fewer(flat.indices.size());
    fewer.resize(meshopt_simplify(fewer.data(), flat.indices.data(), flat.indices.size(), flat.positions.data(), count,
                                  stride, wanted, kAnyError));
    if (fewer.size() > wanted + wanted / 2) {  // many small parts: they cannot be kept
      fewer.resize(flat.indices.size());
      fewer.resize(meshopt_simplifySloppy(fewer.data(), flat.indices.data(), flat.indices.size(), flat.positions.data(),
                                          count, stride, wanted, kAnyError));
    }
    if (!fewer.empty()) flat.indices = std::move(fewer);
  }
  meshopt_optimizeVertexCache(flat.indices.data(), flat.indices.data(), flat.indices.size(), count);
  std::vector<float> used(flat.positions.size());
  used.resize(3 * meshopt_optimizeVertexFetch(used.data(), flat.indices.data(), flat.indices.size(),
                                              flat.positions.data(), count, stride));
  flat.positions = std::move(used);
  return flat;
}

class Bytes {
 public:
  template <class T>
  void raw(T value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);  // little endian, as every browser's machine
  }
  // A plane for each byte: what is alike stands together, which deflates best.
  template <class T>
  void planes(const std::vector<T>& values) {
    for (std::size_t byte = 0; byte < sizeof(T); ++byte)
      for (const T value : values) bytes_ += static_cast<char>(value >> 8 * byte);
  }
  std::string deflated() const {
    uLongf size = compressBound(bytes_.size());
    std::string out(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes_.data()),
                  bytes_.size(), Z_BEST_COMPRESSION) != Z_OK)
      throw std::runtime_error("zlib cannot deflate a mesh");
    out.resize(size);
    return out;
  }

 private:
  std::string bytes_;
};

}  // namespace

std::string packed(const Mesh& mesh, int triangles) {
  if (mesh.triangles.empty()) throw std::invalid_argument("a mesh without triangles cannot be shown");
  const Flat flat = simplified(mesh, triangles);
  const std::size_t vertices = flat.positions.size() / 3;
  float low[3], high[3];
  for (std::size_t k = 0; k < 3; ++k) {
    low[k] = high[k] = flat.positions[k];
    for (std::size_t i = k; i < flat.positions.size(); i += 3)
      low[k] = std::min(low[k], flat.positions[i]), high[k] = std::max(high[k], flat.positions[i]);
  }
  const float longest = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2], 1e-30f});

  Bytes bytes;
  bytes.raw(static_cast<std::uint32_t>(vertices));
  bytes.raw(static_cast<std::uint32_t>(flat.indices.size()));
  for (const float k : low) bytes.raw(k);
  bytes.raw(longest / kSteps);
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<std::uint16_t> steps(vertices);
    std::uint16_t last = 0;
    for (std::size_t i = 0; i < vertices; ++i) {
      const auto place =
          static_cast<std::uint16_t>(std::lround((flat.positions[3 * i + k] - low[k]) / longest * kSteps));
      steps[i] = static_cast<std::uint16_t>(place - last);
      last = place;
    }
    bytes.planes(steps);
  }
  std::vector<std::uint32_t> back;
  std::uint32_t next = 0;
  for (const unsigned index : flat.indices) {
    back.push_back(next - index);
    if (index == next) ++next;
  }
  bytes.planes(back);
  return base64(bytes.deflated());
}

std::string base64(const std::string& bytes) {
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned block = 0;
    for (std::size_t k = 0; k < 3; ++k)
      block = block << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? digits[block >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

}  // namespace carve::experiments
