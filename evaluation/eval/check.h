#pragma once
#include <iosfwd>
#include <string>

#include "carve/mesh/topology.h"

namespace carve {

/// All that mesh_check says of a mesh.
struct MeshReport {
  Topology topology;
  std::int64_t self_intersections = 0;  // pairs of triangles, without those in contact
  std::int64_t contacts = 0;            // pairs of triangles that only touch in a point (mesh/self_intersections.h)

  /// Closed, oriented, 2-manifold, no self-intersection, no degenerate triangle, counter-clockwise from outside.
  bool pass() const { return why_not().empty(); }
  std::string why_not() const;  // "3 boundary edges, 1 self-intersection"; empty if it passes
};

/// \throws std::invalid_argument if an index is out of range or a coordinate is not finite
MeshReport inspect(const Mesh& mesh);
std::ostream& operator<<(std::ostream& out, const MeshReport& report);  // one aligned line a field
std::string to_json(const MeshReport& report);

}  // namespace carve
