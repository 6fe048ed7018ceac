#pragma once
#include <span>

#include "carve/grid/edge_crossings.h"
#include "carve/grid/voxel_grid.h"
#include "carve/views/view_set.h"

namespace carve {

/// What is rounded by a scaled contour.
enum class ConvexRule {
  parts,      // parts that two drawings show curved
  as_printed  // the whole object, slice by slice, by a drawing whose silhouette is convex: Algorithm 3.5
};
inline std::span<const char* const> names(ConvexRule) {
  static constexpr const char* all[] = {"parts", "as_printed"};
  return all;
}

struct ConvexOptions {
  bool arm = true;
  ConvexRule rule = ConvexRule::parts;
  double evidence = 0.3;
  double bend = 0.4;
  double grown = 0.2;
  double scale = 2;
};
template <class Visitor>
void visit_fields(ConvexOptions& o, Visitor&& field) {
  field("arm", o.arm, "parts that two drawings show curved are rounded");
  field("rule", o.rule, "what is rounded: parts that drawings show curved, or slices of the whole as printed");
  field("evidence", o.evidence, 0.01, 1.0,
        "share of a part's corners between two sloping outlines that makes it round");
  field("bend", o.bend, 0.05, 100.0, "least curvature of its outlines: rms distance from lines, % of the longest side");
  field("grown", o.grown, -1.0, 1.01,
        "every section is rounded where so much larger a share of corners lies between drifting outlines than between "
        "upright ones; above 1: only parts that are shown curved");
  field("scale", o.scale, 0.0, 100.0,
        "of such a solid edges are rounded too that are wider than twice the arc sine of 1 / scale: 60 degrees at 2; "
        "up to 1: none");
}

struct Refinement {
  VoxelGrid grid;
  AxisCrossings crossings;  // of the rounded surface, which no drawing shows
};

/// Convex silhouette refinement (thesis 3.1.3, Algorithm 3.5) \cite silva_2018, generalised from slices of the whole
/// object to its parts (carving/sections.h): a section's box, which two drawings give, is filled by a scaled contour
/// instead of a rectangle, so that three circles make a sphere and not three crossed cylinders.
///
/// A part is rounded where both drawings show it curved, or where it tapers from a section that the third shows as an
/// ellipse, as a cone does: boxes, prisms, stairs and other straight tapers stay as they are. The contour is the
/// superellipse \cite barr_1981 whose fill (area over its box's) is that of the part's own outlines, or of that
/// section; sections of `solid` that are not convex stay. Slices across all three axes are intersected.
///
/// A solid whose outlines hardly ever stand upright, like an animal's, looks grown: there every section is filled by an
/// ellipse, in the corners between two outlines that drift, as far as the sections around it are. What blunt edges that
/// leaves are rounded by the scale axis transform (carving/scale_axis.h).
///
/// The result lies inside `solid` and casts the same shadow in every view: on each ray the voxels deepest inside their
/// sections' contours stay; in a solid that looks grown, those around them that are as deep, too.
///
/// As printed, the other silhouettes may break and there are no crossings. Arm off: `solid` itself. \param views
/// drawings that `solid` was carved from \throws std::invalid_argument on an option out of range
Refinement refine_convex(const VoxelGrid& solid, const ViewSet& views, const ConvexOptions& options = {});

}  // namespace carve
