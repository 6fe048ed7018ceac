#pragma once
#include <array>
#include <vector>

#include "carve/core/vector.h"

namespace carve {

using Triangle = std::array<int, 3>;  // indices of positions, counter-clockwise seen from outside

/// A triangle mesh in world axes (views/frame.h). Plain data: nothing here promises that it is closed (mesh/topology.h
/// checks that).
struct Mesh {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  bool operator==(const Mesh&) const = default;
};

}  // namespace carve
