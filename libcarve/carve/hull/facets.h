#pragma once
#include <array>
#include <span>
#include <vector>

#include "carve/hull/exact_point.h"

namespace carve::hull {

/// A plane with its outward side: points of one facet lie in one plane.
struct FacetPlane {
  std::array<std::int64_t, 3> normal;  // outward, any length
};

/// A directed side of a facet, the facet on its left seen from outside. What is at its `from` end is a corner of the
/// facet, and known by the side's index.
struct FacetSide {
  int from = -1, to = -1;  // points
  int plane = -1;
  int source = -1;  // the contour edge that the facet comes from

  int next = -1, before = -1;  // along the facet's border
  int partner = -1;            // the same side of the neighbouring facet, in the opposite direction
  bool touching = false;       // more than two facets meet in this line
};

/// From the borders of facets that together bound a solid to linked facets:
/// - sides are split where others end on them (T-junctions);
/// - sides between two facets of one plane vanish, so coplanar facets become one;
/// - where four or more facets meet in a side, those that bound the same part of the solid are partners;
/// - points in which only two facets meet (middles of straight sides) are dropped.
/// \throws std::logic_error if the sides do not bound a solid
std::vector<FacetSide> link_facets(const std::vector<ExactPoint>& points, std::span<const FacetPlane> planes,
                                   std::vector<FacetSide> sides);

/// A point of a facet that lies in the middle of one of its sides.
struct Pinch {
  int side, point;
};

struct Triangulation {
  std::vector<std::array<int, 3>> triangles;  // triples of corners, counter-clockwise from outside, none degenerate
  std::vector<Pinch> pinches;                 // if there are any the triangles are worth nothing
};

/// A sweep over each plane from left to right, exact \cite hertel_1983.
Triangulation triangulate_facets(const std::vector<ExactPoint>& points, std::span<const FacetPlane> planes,
                                 std::span<const FacetSide> sides);

/// The pinched sides end in those points, so that the facets fall apart there.
void split_pinches(const std::vector<ExactPoint>& points, std::span<const FacetPlane> planes,
                   std::span<const Pinch> pinches, std::vector<FacetSide>& sides);

}  // namespace carve::hull
