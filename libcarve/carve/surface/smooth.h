#pragma once
#include <span>

#include "carve/core/monitor.h"
#include "carve/mesh/mesh.h"
#include "carve/surface/guides.h"

namespace carve {

enum class Smoothing {
  laplacian,  // Equation 3.7: shrinks
  taubin      // a step inwards, then one outwards \cite taubin_1995: keeps the volume
};
inline std::span<const char* const> names(Smoothing) {
  static constexpr const char* all[] = {"laplacian", "taubin"};
  return all;
}

struct SmoothOptions {
  int steps = 2;
  double level = 180;  // degrees
  Smoothing method = Smoothing::laplacian;
  bool keep = true;
  bool mend = true;
};
template <class Visitor>
void visit_fields(SmoothOptions& o, Visitor&& field) {
  field("steps", o.steps, 0, 1000, "smoothing steps");
  field("level", o.level, 0.0, 180.0,
        "largest angle in degrees between neighbouring triangles' normals that is still smoothed; sharper edges stay");
  field("method", o.method, "laplacian shrinks, taubin keeps the volume");
  field("keep", o.keep,
        "with intersections: outlines, edges and corners that the drawings show stay, vertices slide along them");
  field("mend", o.mend, "vertices go back to where they were if the surface would pass through itself");
}

/// Laplacian smoothing (thesis 3.1.6, Equation 3.7; level: A.1.3.2) \cite bardyn_2010: each step moves every vertex to
/// the mean of its one-ring, all at once; a vertex on an edge sharper than `level` stays. Taubin's steps go half the
/// way there, then a little more than half the way back, which leaves all but the rough alone. Topology is kept; zero
/// steps or level 0 is the identity. With `mend` a mesh that does not pass through itself (mesh/self_intersections.h)
/// does not afterwards either, nor once it is rounded to floats. \param guides  with `keep`: one a vertex, which limits
/// each of its steps; or none \throws std::invalid_argument on an option out of range, or guides of another mesh
Mesh smooth(Mesh mesh, const SmoothOptions& options = {}, const Monitor& monitor = {}, const Guides& guides = {});

}  // namespace carve
