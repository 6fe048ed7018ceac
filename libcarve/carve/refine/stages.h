#pragma once
#include <optional>

#include "carve/mesh/mesh.h"

namespace carve {

/// What the stages below are given; lengths in object units (longest side 1).
struct StageOptions {
  double feature = 60;                     // degrees between normals: sharper edges are features
  int iterations = 3;                      // of remesh, smooth_shape, angle_and_area, tangential
  std::optional<double> edge_length = {};  // of remesh; automatic: the mean edge length
  std::optional<double> shape_time = {};   // of smooth_shape, a step; automatic: the mean edge length squared
  int parts = 100;                         // of segment
  double flatness = 0.004;                 // of segment: how far a part may lie from its plane
  double wrap_detail = 0.01;               // of alpha_wrap
  bool wrap_always = false;
};
template <class Visitor>
void visit_fields(StageOptions& o, Visitor&& field) {
  field("feature", o.feature, 0.0, 180.0, "edges whose normals differ by more degrees are features that stay");
  field("iterations", o.iterations, 0, 100, "iterations of remesh, smooth_shape, angle_and_area and tangential");
  field("edge_length", o.edge_length, 1e-4, 1.0, "remesh's edge length; auto: the mesh's mean");
  field("shape_time", o.shape_time, 0.0, 1.0, "time step of smooth_shape; auto: the mean edge length squared");
  field("parts", o.parts, 1, 10000, "parts that segment finds");
  field("flatness", o.flatness, 0.0, 1.0, "how far a part that segment flattens may lie from its plane");
  field("wrap_detail", o.wrap_detail, 1e-3, 1.0, "radius of the balls that alpha_wrap presses against the mesh");
  field("wrap_always", o.wrap_always, "alpha_wrap runs even if the mesh does not pass through itself");
}

// Each takes a solid mesh (Topology::solid) and gives another; nothing is promised of self-intersections, refine()
// (refine/refine.h) looks after those. The same mesh gives the same bytes. \throws std::invalid_argument on an option
// out of range

/// Isotropic remeshing: edges of one length, features kept \cite botsch_2004.
Mesh remesh(const Mesh& mesh, const StageOptions& options = {});

// These move vertices and leave the triangles as they are.

/// Mean-curvature flow with a fixed stiffness matrix, so that necks do not pinch \cite kazhdan_2012; features stay.
/// The volume that it takes is given back by an even offset along the normals.
Mesh smooth_shape(const Mesh& mesh, const StageOptions& options = {});
/// Evens out angles and areas around the vertices, then projects back onto the surface; features stay
/// \cite surazhsky_2004.
Mesh angle_and_area(const Mesh& mesh, const StageOptions& options = {});
/// Moves vertices to the middle of their neighbours within the tangent plane; features move along themselves.
Mesh tangential(const Mesh& mesh, const StageOptions& options = {});
/// Variational shape approximation \cite cohen_steiner_2004 into parts, then each vertex goes to the planes of the flat
/// ones among the parts that it borders on.
Mesh segment(const Mesh& mesh, const StageOptions& options = {});

/// Edge collapse by quadrics \cite garland_1997 to `faces` triangles, or as near as the link condition allows without
/// that the surface passes through itself more often than it did: where it would, vertices are kept in another attempt,
/// and triangles then collapsed in several rounds.
Mesh decimate(const Mesh& mesh, int faces);

/// A closed surface without self-intersections around the mesh, whatever the mesh is (solid or not)
/// \cite portaneri_2022: within gaps that its balls enter a tenth of wrap_detail away from it; no gap narrower than
/// wrap_detail is entered.
Mesh alpha_wrap(const Mesh& mesh, const StageOptions& options = {});

}  // namespace carve
