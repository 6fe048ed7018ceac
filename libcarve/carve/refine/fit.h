#pragma once
#include "carve/core/monitor.h"
#include "carve/mesh/mesh.h"
#include "carve/views/view_set.h"

namespace carve {

struct FitOptions {
  int rounds = 10;     // new normals, curvatures and rims each; on a coarse copy first
  double bend = 1.5;   // over how far the surface is bent, as a share of the outlines' inner radius there
  double crease = 30;  // degrees between normals from which a drawn line keeps an edge sharp
};
template <class Visitor>
void visit_fields(FitOptions& o, Visitor&& field) {
  field("fit_rounds", o.rounds, 0, 100, "rounds of fit");
  field("fit_bend", o.bend, 0.0, 10.0,
        "over how far fit bends the surface, as a share of how thick the object is drawn there");
  field("fit_crease", o.crease, 0.0, 180.0, "edges sharper than that stay where lines or straight outlines are drawn");
}

/// Bends a surface as evenly as its drawings allow. Vertices move along their normals so that curvature approaches its
/// mean over a neighbourhood, in the manner of \cite nealen_2007; the neighbourhood is as large as the object is thick
/// there, so that limbs become round and do not wither. The mesh's rim in each view is pulled onto the drawn outline,
/// to a fraction of a pixel, and what leaves a silhouette goes back onto it: the result lies in the visual hull. Sharp
/// edges along drawn strokes stay; so do walls, which an outline shows as long straight lines, and the edges around
/// them. Least squares by Ceres on one thread, a fixed number of steps: the same bytes everywhere. Self-intersections
/// are not looked for (refine/refine.h does that). \param mesh  solid, in the views' object units \throws
/// std::invalid_argument on an option out of range
Mesh fit(const Mesh& mesh, const ViewSet& views, const FitOptions& options = {}, const Monitor& monitor = {});

}  // namespace carve
