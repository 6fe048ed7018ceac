#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Nef_polyhedron_3.h>
#include <CGAL/Surface_mesh.h>
#include <gmpxx.h>

#include <map>
#include <stdexcept>

#include "carve/hull/exact_hull.h"
#include "carve/hull/rational_point.h"

namespace carve::hull {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Nef = CGAL::Nef_polyhedron_3<Kernel>;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
using PlaneKey = std::array<mpq_class, 4>;

Nef nef_of(const Prism& prism) {
  Surface surface;
  std::vector<Surface::Vertex_index> vertices;
  for (const auto& [x, y, z] : prism.points) vertices.push_back(surface.add_vertex({x, y, z}));
  for (const auto& [a, b, c] : prism.triangles) surface.add_face(vertices[a], vertices[b], vertices[c]);
  return Nef(surface);
}

// The plane's coefficients, so scaled that the largest is 1 or -1.
PlaneKey plane_key(PlaneKey plane) {
  mpq_class scale = 0;
  for (int axis = 0; axis < 3; ++axis) scale = std::max(scale, mpq_class(abs(plane[axis])));
  for (mpq_class& x : plane) x /= scale;
  return plane;
}

/// The contour edge that sweeps a plane; of several the first one.
std::map<PlaneKey, int> edges_of_planes(const Silhouettes& silhouettes, std::span<const ContourEdge> edges,
                                        const SweptPlanes& planes) {
  std::map<PlaneKey, int> found;
  for (int i = 0; i < static_cast<int>(edges.size()); ++i) {
    const int w = silhouettes.along[edges[i].silhouette].axis;
    const auto& n = planes.planes[planes.of_edge[i]].normal;
    PlaneKey plane;
    for (int axis = 0; axis < 3; ++axis) plane[axis] = mpq_class(static_cast<signed long>(n[axis]));
    plane[3] = -(plane[(w + 1) % 3] * edges[i].from[0] + plane[(w + 2) % 3] * edges[i].from[1]);
    found.try_emplace(plane_key(plane), i);
  }
  return found;
}

// Six times the volume of the tetrahedra from the origin to a fan over the cycle.
mpq_class six_volumes(const std::vector<std::array<mpq_class, 3>>& cycle) {
  mpq_class sum = 0;
  const auto& a = cycle[0];
  for (std::size_t i = 1; i + 1 < cycle.size(); ++i) {
    const auto &b = cycle[i], &c = cycle[i + 1];
    sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return sum;
}

}  // namespace

ExactHull nef(const Silhouettes& silhouettes) {
  Nef solid = nef_of(prism(silhouettes.along[0]));
  for (std::size_t k = 1; k < silhouettes.along.size(); ++k)
    solid = solid.intersection(nef_of(prism(silhouettes.along[k])));
  solid = solid.regularization();  // without it pixel contours leave sheets

  const std::vector<ContourEdge> edges = contour_edges(silhouettes);
  SweptPlanes planes = swept_planes(silhouettes, edges);
  const std::map<PlaneKey, int> edge_of = edges_of_planes(silhouettes, edges, planes);
  PointIndex points;
  ExactHull hull;
  mpq_class volume = 0;
  for (auto facet = solid.halffacets_begin(); facet != solid.halffacets_end(); ++facet) {
    if (facet->incident_volume()->mark() || !facet->twin()->incident_volume()->mark()) continue;  // seen from outside
    const auto plane = facet->plane().exact();
    const auto number = [](const auto& x) { return mpq_class(rational(x)); };
    const int edge =
        edge_of.at(plane_key({number(plane.a()), number(plane.b()), number(plane.c()), number(plane.d())}));
    for (auto cycle = facet->facet_cycles_begin(); cycle != facet->facet_cycles_end(); ++cycle) {
      if (!cycle.is_shalfedge()) throw std::logic_error("a hull's facet has a point of its own");
      Nef::SHalfedge_around_facet_const_circulator at(cycle), end(at);
      std::vector<int> corners;
      std::vector<std::array<mpq_class, 3>> coordinates;
      CGAL_For_all(at, end) {
        const auto p = at->source()->center_vertex()->point().exact();
        corners.push_back(points(rational_point({rational(p.x()), rational(p.y()), rational(p.z())})));
        coordinates.push_back({number(p.x()), number(p.y()), number(p.z())});
      }
      volume += six_volumes(coordinates);
      for (std::size_t i = 0; i < corners.size(); ++i)
        hull.sides.push_back({corners[i], corners[(i + 1) % corners.size()], planes.of_edge[edge], edge});
    }
  }
  hull.points = points.points();
  hull.planes = std::move(planes.planes);
  hull.volume = mpq_class(volume / 6).get_str();
  return hull;
}

}  // namespace carve::hull
