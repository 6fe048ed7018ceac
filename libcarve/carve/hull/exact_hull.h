#pragma once
#include <string>
#include <vector>

#include "carve/hull/facets.h"
#include "carve/hull/polyhedral_hull.h"

namespace carve::hull {

/// A hull before it is rounded: the borders of facets in exact coordinates. Every method makes one of these.
struct ExactHull {
  std::vector<ExactPoint> points;
  std::vector<FacetPlane> planes;
  std::vector<FacetSide> sides;
  std::string volume = {};  // as CGAL's methods tell it of their own result: "p/q"
};

ExactHull strips(const Silhouettes& silhouettes);
ExactHull nef(const Silhouettes& silhouettes);  // the only Nef polyhedra of the project: compiling takes minutes
ExactHull corefinement(const Silhouettes& silhouettes);  // \throws NoResult if CGAL cannot represent the result

/// What a silhouette sweeps, as a closed mesh; it ends beyond the lattice. Coordinates are integers.
struct Prism {
  std::vector<std::array<std::int32_t, 3>> points;
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> edge;  // per triangle: the contour edge, counted through the loops; -1: an end of the prism
};
Prism prism(const Silhouette& silhouette);

/// A contour's edge with the inside on its left, in the silhouette's own two axes. An index of the list of all
/// silhouettes' edges is a FacetSide's source.
struct ContourEdge {
  int silhouette;  // of Silhouettes::along
  int loop, edge;  // from vertex `edge` of the loop to the next one
  LatticePoint from, to;
};
std::vector<ContourEdge> contour_edges(const Silhouettes& silhouettes);

/// The planes that the edges sweep, edges in one axis-aligned plane with one outward side sharing theirs.
struct SweptPlanes {
  std::vector<FacetPlane> planes;
  std::vector<int> of_edge;
};
SweptPlanes swept_planes(const Silhouettes& silhouettes, std::span<const ContourEdge> edges);

/// The solid's volume in cubic lattice units, reduced: "p/q".
std::string exact_volume(const std::vector<ExactPoint>& points, std::span<const FacetSide> sides,
                         std::span<const std::array<int, 3>> triangles);

}  // namespace carve::hull
