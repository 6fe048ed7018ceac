#pragma once
#include <span>
#include <string>
#include <vector>

#include "carve/hull/silhouette.h"
#include "carve/mesh/mesh.h"

namespace carve {

enum class HullMethod {
  none,
  nef,           // CGAL's Nef polyhedra \cite hachenberger_2007
  corefinement,  // CGAL's corefinement of triangle meshes \cite loriot_2009
  strips         // every contour edge's strip clipped by the other silhouettes \cite rivers_2010
};
inline std::span<const char* const> names(HullMethod) {
  static constexpr const char* all[] = {"none", "nef", "corefinement", "strips"};
  return all;
}

/// The contour edge that a triangle was swept from.
struct ContourSide {
  View view;
  int loop, edge;  // of the view's silhouette: from vertex `edge` of the loop to the next one
};

struct PolyhedralHull {
  Mesh mesh;                         // object units
  std::vector<ContourSide> sources;  // per triangle
  int facets = 0;                    // before they were triangulated
  int split_points = 0;              // copies made of points in which parts of the solid only touch
  std::string volume;                // exact, cubic lattice units, "p/q"; empty unless asked for
};

/// The polyhedral visual hull \cite laurentini_1994: the intersection of the silhouettes' prisms, computed without
/// rounding whatever the method; only the final coordinates are rounded, to the nearest double.
///
/// The mesh is closed, oriented and 2-manifold. Coplanar facets are one before they are triangulated. Where parts of
/// the solid only touch, along a line or in a point, they are parted: each part gets its own vertices there,
/// drawn apart by 2^-44. Not parted are edges that cross in a point without a vertex (two grooves from opposite sides,
/// as deep as the solid): there the surface touches itself, and mesh_check reports contacts, not self-intersections.
/// \throws std::invalid_argument for silhouettes that are not two or three of different axes, or whose loops have fewer
/// than three vertices or leave the lattice; NoResult if the intersection is empty
PolyhedralHull polyhedral_hull(const Silhouettes& silhouettes, HullMethod method = HullMethod::strips,
                               bool exact_volume = false);

}  // namespace carve
