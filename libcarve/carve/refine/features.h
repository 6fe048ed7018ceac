#pragma once
// Internal to carve/refine: measures of a solid's edges.
#include <array>
#include <cstdint>
#include <vector>

#include "carve/mesh/mesh.h"

namespace carve::refining {

double mean_edge_length(const Mesh& mesh);

/// Per triangle and side k, from corner k to corner k + 1: 1 if the triangles on both sides have normals that differ by
/// more than `degrees`.
std::vector<std::array<std::uint8_t, 3>> feature_sides(const Mesh& mesh, double degrees);

/// The triangle on the other side of each triangle's sides, in a solid.
std::vector<std::array<int, 3>> neighbours(const Mesh& mesh);

}  // namespace carve::refining
