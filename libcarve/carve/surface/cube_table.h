#pragma once
#include <array>
#include <cstdint>

namespace carve {

/// Marching cubes' cases \cite lorensen_1987. Corner i of a cell lies at (i & 1, i >> 1 & 1, i >> 2 & 1); bit i of a
/// case says that it is inside. Edge 4 d + r runs along axis d, from the corner whose other two coordinates are r & 1
/// (the lower axis) and r >> 1.
///
/// An ambiguous face separates its two inside corners, so what a face shows depends on its four corners only and
/// neighbouring cells agree; each of a cell's loops is triangulated without an inner edge that lies on a face, so no
/// edge gets more than two triangles. Among those triangulations: the largest smallest angle, the vertices taken in the
/// edges' middles.
struct CubeCase {
  std::uint8_t triangles = 0;
  std::array<std::array<std::uint8_t, 3>, 5> edges = {};  // of each triangle, counter-clockwise from outside
};

const std::array<CubeCase, 256>& cube_table();

/// The two corners of an edge, the lower first.
constexpr std::array<int, 2> cube_edge(int edge) {
  const int axis = edge / 4, low = edge & 1, high = edge >> 1 & 1;
  const int from = axis == 0 ? low << 1 | high << 2 : axis == 1 ? low | high << 2 : low | high << 1;
  return {from, from | 1 << axis};
}

}  // namespace carve
