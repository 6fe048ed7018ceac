#include "carve/mesh/adjacency.h"

#include <atomic>
#include <limits>
#include <stdexcept>
#include <string>

#include "carve/core/parallel.h"

namespace carve {
namespace {

constexpr int kGrain = 1 << 15;

bool in_range(const Triangle& triangle, std::size_t vertices) {
  // A negative index is a huge one once unsigned.
  return std::size_t(triangle[0]) < vertices && std::size_t(triangle[1]) < vertices &&
         std::size_t(triangle[2]) < vertices;
}

// The first index below `size` for which `bad` holds, or `size`.
template <class Bad>
std::size_t first_bad(std::size_t size, Bad bad) {
  std::atomic<std::size_t> found = size;
  parallel_ranges(0, static_cast<int>(size), kGrain, [&](int first, int last) {
    for (std::size_t i = first; i < std::size_t(last); ++i) {
      if (!bad(i)) continue;
      std::size_t earliest = found;
      while (i < earliest && !found.compare_exchange_weak(earliest, i)) {
      }
      return;
    }
  });
  return found;
}

}  // namespace

void check_mesh(const Mesh& mesh) {
  const std::size_t vertices = mesh.positions.size(), triangles = mesh.triangles.size();
  if (vertices > std::size_t(std::numeric_limits<int>::max()))
    throw std::invalid_argument("mesh.positions must hold at most 2147483647 vertices, got " +
                                std::to_string(vertices));
  if (triangles > std::numeric_limits<std::uint32_t>::max() / 3)
    throw std::invalid_argument("mesh.triangles must hold at most 1431655765 triangles, got " +
                                std::to_string(triangles));
  const std::size_t t = first_bad(triangles, [&](std::size_t i) { return !in_range(mesh.triangles[i], vertices); });
  if (t < triangles) {
    const auto& [a, b, c] = mesh.triangles[t];
    const int bad = std::size_t(a) >= vertices ? a : std::size_t(b) >= vertices ? b : c;
    throw std::invalid_argument("mesh.triangles[" + std::to_string(t) + "] must index one of " +
                                std::to_string(vertices) + " vertices, got " + std::to_string(bad));
  }
  const std::size_t v = first_bad(vertices, [&](std::size_t i) { return !mesh.positions[i].allFinite(); });
  if (v < vertices) throw std::invalid_argument("mesh.positions[" + std::to_string(v) + "] must be finite");
}

VertexTriangles vertex_triangles(const Mesh& mesh) {
  check_mesh(mesh);
  const std::size_t vertices = mesh.positions.size(), triangles = mesh.triangles.size();
  VertexTriangles rows{std::vector<std::uint32_t>(vertices + 2), std::vector<int>(3 * triangles)};
  // Counting sort. The counts stand two places ahead of their vertex while they are made into beginnings, so that
  // filling a row moves its beginning to where it belongs.
  std::vector<std::uint32_t>& first = rows.first;
  for (const Triangle& triangle : mesh.triangles)
    for (const int v : triangle) ++first[v + 2];
  for (std::size_t v = 2; v < first.size(); ++v) first[v] += first[v - 1];
  for (std::size_t t = 0; t < triangles; ++t)
    for (const int v : mesh.triangles[t]) rows.triangles[first[v + 1]++] = static_cast<int>(t);
  first.pop_back();
  return rows;
}

}  // namespace carve
