#pragma once
#include <cstdint>
#include <iosfwd>

#include "carve/mesh/mesh.h"

namespace carve {

/// What a mesh is, as a combinatorial surface and as a solid. Vertices are told apart by their index, never by their
/// position, so the counts are exact; only degenerate_triangles, area and volume look at coordinates.
struct Topology {
  std::int64_t vertices = 0, edges = 0, triangles = 0;
  std::int64_t boundary_edges = 0;        // edges of one triangle
  std::int64_t nonmanifold_edges = 0;     // edges of three or more triangles, or from a vertex to itself
  std::int64_t misoriented_edges = 0;     // edges whose two triangles run through them the same way
  std::int64_t nonmanifold_vertices = 0;  // vertices in use whose link is neither a path nor a cycle of three or more
  std::int64_t unused_vertices = 0;
  std::int64_t degenerate_triangles = 0;  // two corners at one index, or an area that rounding cannot tell from zero
  std::int64_t components = 0;            // parts that share no vertex
  std::int64_t euler = 0;                 // vertices in use - edges + triangles
  std::int64_t genus = 0;                 // handles, summed over components; meaningful if solid()
  double area = 0;
  double volume = 0;  // positive if triangles are counter-clockwise from outside; meaningful if closed()

  bool closed() const { return triangles > 0 && boundary_edges == 0; }
  bool manifold() const { return nonmanifold_edges == 0 && nonmanifold_vertices == 0; }
  bool oriented() const { return misoriented_edges == 0; }
  /// What every mesh we write must be: closed, oriented, 2-manifold.
  bool solid() const { return closed() && manifold() && oriented(); }
};

/// The same value, to the last bit, whatever the thread count. Memory beside the mesh: 12 bytes a triangle, 4 a vertex.
/// \throws std::invalid_argument if an index is out of range or a coordinate is not finite
Topology topology(const Mesh& mesh);
std::ostream& operator<<(std::ostream& out, const Topology& topology);  // one aligned line a field

}  // namespace carve
