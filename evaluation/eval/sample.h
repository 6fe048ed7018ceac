#pragma once
#include <vector>

#include "carve/mesh/mesh.h"

namespace carve {

/// Points spread evenly over a mesh's area.
struct Samples {
  std::vector<Vec3> points;
  std::vector<int> triangles;  // that each lies on
};

/// `count` points, one in every 1/count-th of the area in the order of the triangles (stratified, so that means
/// converge faster than 1/sqrt(count)), uniform within. The same mesh, count and seed: the same points.
/// \throws std::invalid_argument if count < 1 or the mesh has no area
Samples sample_surface(const Mesh& mesh, int count, unsigned seed);

}  // namespace carve
