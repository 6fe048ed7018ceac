#pragma once
// Internal to carve/refine: meshes to and from CGAL's; templates, so that no CGAL type stands here.
#include <utility>
#include <vector>

#include "carve/mesh/mesh.h"

namespace carve::refining {

/// Vertex i of the mesh becomes vertex i, triangle i face i.
template <class SurfaceMesh>
SurfaceMesh surface_mesh_of(const Mesh& mesh) {
  using Vertex = typename SurfaceMesh::Vertex_index;
  SurfaceMesh surface;
  surface.reserve(mesh.positions.size(), mesh.triangles.size() * 3 / 2, mesh.triangles.size());
  for (const Vec3& p : mesh.positions) surface.add_vertex(typename SurfaceMesh::Point(p.x(), p.y(), p.z()));
  for (const auto& [a, b, c] : mesh.triangles) surface.add_face(Vertex(a), Vertex(b), Vertex(c));
  return surface;
}

template <class SurfaceMesh>
Mesh mesh_of(const SurfaceMesh& surface) {
  Mesh mesh;
  mesh.positions.reserve(surface.number_of_vertices());
  mesh.triangles.reserve(surface.number_of_faces());
  std::vector<int> index(surface.num_vertices(), -1);  // with those that were removed
  for (const auto v : surface.vertices()) {
    const auto& p = surface.point(v);
    index[v] = static_cast<int>(mesh.positions.size());
    mesh.positions.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto f : surface.faces()) {
    const auto first = surface.halfedge(f), second = surface.next(first);
    mesh.triangles.push_back(
        {index[surface.target(first)], index[surface.target(second)], index[surface.target(surface.next(second))]});
  }
  return mesh;
}

/// The mesh with the surface's positions; their vertices must correspond.
template <class SurfaceMesh>
Mesh moved(Mesh mesh, const SurfaceMesh& surface) {
  for (const auto v : surface.vertices()) {
    const auto& p = surface.point(v);
    mesh.positions[v] = {p.x(), p.y(), p.z()};
  }
  return mesh;
}

}  // namespace carve::refining
