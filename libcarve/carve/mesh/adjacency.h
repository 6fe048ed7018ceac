#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "carve/mesh/mesh.h"

namespace carve {

/// The triangles around each vertex, in rising order.
struct VertexTriangles {
  std::vector<std::uint32_t> first;  // #V + 1: where each vertex's triangles begin
  std::vector<int> triangles;        // 3 #T; a triangle that has a vertex at two corners stands there twice

  std::span<const int> operator[](int vertex) const {
    return {triangles.data() + first[vertex], first[vertex + 1] - first[vertex]};
  }
};

/// Linear in time and memory: 4 bytes a vertex and 12 a triangle. \throws std::invalid_argument as check_mesh
VertexTriangles vertex_triangles(const Mesh& mesh);

/// \throws std::invalid_argument: an index that is not one of a position, a coordinate that is not finite, or more than
/// 1.4e9 triangles
void check_mesh(const Mesh& mesh);

}  // namespace carve
