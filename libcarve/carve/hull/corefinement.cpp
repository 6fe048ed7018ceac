#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Surface_mesh.h>
#include <gmpxx.h>

#include "carve/core/error.h"
#include "carve/hull/exact_hull.h"
#include "carve/hull/rational_point.h"

namespace carve::hull {
namespace {

// With inexact constructions CGAL crashes on axis-aligned prisms (CGAL issue 9455).
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
namespace processing = CGAL::Polygon_mesh_processing;

/// Tells the parts of a face, and their copies in the result, which contour edge the face was swept from.
struct KeepEdges : processing::Corefinement::Default_visitor<Surface> {
  static Surface::Property_map<Surface::Face_index, int> edge(Surface& surface) {
    return surface.add_property_map<Surface::Face_index, int>("f:edge", -1).first;
  }
  static int edge_of(const Surface& surface, Surface::Face_index face) {
    return surface.property_map<Surface::Face_index, int>("f:edge").first[face];
  }

  int whole = -1;
  void before_subface_creations(Surface::Face_index face, Surface& surface) { whole = edge_of(surface, face); }
  void after_subface_created(Surface::Face_index face, Surface& surface) { edge(surface)[face] = whole; }
  void after_face_copy(Surface::Face_index from, const Surface& source, Surface::Face_index to, Surface& result) {
    edge(result)[to] = edge_of(source, from);
  }
};

Surface surface_of(const Prism& prism, int first_edge) {
  Surface surface;
  std::vector<Surface::Vertex_index> vertices;
  for (const auto& [x, y, z] : prism.points) vertices.push_back(surface.add_vertex({x, y, z}));
  auto edge = KeepEdges::edge(surface);
  for (std::size_t t = 0; t < prism.triangles.size(); ++t) {
    const auto& [a, b, c] = prism.triangles[t];
    const auto face = surface.add_face(vertices[a], vertices[b], vertices[c]);
    edge[face] = prism.edge[t] < 0 ? -1 : prism.edge[t] + first_edge;
  }
  return surface;
}

/// CGAL leaves coplanar faces in many pieces, with vertices in the middle of straight edges whose coordinates have any
/// number of digits. Sides run between vertices in which three planes meet.
ExactHull borders(const Surface& solid, const SweptPlanes& planes) {
  const auto plane = [&](Surface::Halfedge_index h) {
    return planes.of_edge.at(KeepEdges::edge_of(solid, solid.face(h)));
  };
  const auto is_edge = [&](Surface::Halfedge_index h) { return plane(h) != plane(solid.opposite(h)); };
  std::vector<int> degree(solid.number_of_vertices() + solid.number_of_removed_vertices());
  for (const auto h : solid.halfedges()) degree[solid.target(h)] += is_edge(h);

  PointIndex points;
  std::vector<int> index(degree.size(), -1);
  const auto index_of = [&](Surface::Vertex_index vertex) {
    if (index[vertex] < 0) {
      const auto& p = solid.point(vertex).exact();
      index[vertex] = points(rational_point({rational(p.x()), rational(p.y()), rational(p.z())}));
    }
    return index[vertex];
  };
  ExactHull hull;
  for (const auto h : solid.halfedges()) {
    if (!is_edge(h) || degree[solid.source(h)] < 3) continue;
    auto last = h;
    while (degree[solid.target(last)] < 3) {
      last = solid.next(last);
      while (!is_edge(last)) last = solid.next(solid.opposite(last));
    }
    hull.sides.push_back(
        {index_of(solid.source(h)), index_of(solid.target(last)), plane(h), KeepEdges::edge_of(solid, solid.face(h))});
  }
  hull.points = points.points();
  hull.planes = planes.planes;
  return hull;
}

}  // namespace

ExactHull corefinement(const Silhouettes& silhouettes) {
  Surface solid;
  int first_edge = 0;
  for (const Silhouette& silhouette : silhouettes.along) {
    Surface swept = surface_of(prism(silhouette), first_edge);
    for (const LatticeLoop& loop : silhouette.loops) first_edge += static_cast<int>(loop.size());
    if (silhouette.axis == silhouettes.along[0].axis) {
      solid = std::move(swept);
      continue;
    }
    Surface both;
    KeepEdges::edge(both);
    const auto visitor = CGAL::parameters::visitor(KeepEdges());
    if (!processing::corefine_and_compute_intersection(solid, swept, both, visitor))
      throw NoResult("corefinement: the prisms' intersection is not a 2-manifold, which CGAL's meshes must be");
    solid = std::move(both);
  }

  const SweptPlanes planes = swept_planes(silhouettes, contour_edges(silhouettes));
  ExactHull hull = borders(solid, planes);
  const auto volume = processing::volume(solid).exact();
  hull.volume = mpq_class(rational(volume)).get_str();
  return hull;
}

}  // namespace carve::hull
