#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "carve/core/monitor.h"
#include "carve/mesh/mesh.h"
#include "carve/refine/fit.h"
#include "carve/refine/stages.h"

namespace carve {

struct RefineOptions {
  std::vector<std::string> arm = {};  // names of stages, run in this order
  std::optional<int> faces = {};      // triangles to leave; decimate comes last unless it is named
  StageOptions stages = {};
  FitOptions fit = {};
};
/// `faces` is not among them: the pipeline has it as an option of its own, --faces.
template <class Visitor>
void visit_fields(RefineOptions& o, Visitor&& field) {
  field(
      "arm", o.arm,
      "stages in their order, of remesh, smooth_shape, angle_and_area, tangential, segment, fit, decimate, alpha_wrap");
  visit_fields(o.stages, field);
  visit_fields(o.fit, field);
}

std::string refinement_names();  // "remesh, smooth_shape, ..."

/// What became of a stage.
struct RefinementStep {
  std::string stage;
  bool kept = true;           // false: the stage broke the mesh and was rolled back
  std::string why = {};       // it was rolled back, vertices were put back, or decimate left more than asked for
  std::int64_t put_back = 0;  // vertices that were moved into other triangles and went back where they were
  std::int64_t triangles = 0, self_intersections = 0;  // after it
  double seconds = 0;
};

struct RefinedMesh {
  Mesh mesh;
  std::vector<RefinementStep> steps;
};

/// Runs the stages one after another on a solid mesh. After each one the mesh must still be solid and turned outwards,
/// with no new degenerate triangle and no new pair of triangles that meet (mesh/self_intersections.h). Where a stage
/// that only moves vertices made triangles meet, those vertices are put back; what is broken otherwise is rolled back
/// as a whole. alpha_wrap, the last resort, runs only where triangles meet, unless stages.wrap_always says so. The same
/// mesh and options give the same bytes, whatever the thread count. \throws std::invalid_argument: an unknown stage, an
/// option out of range, a mesh that is not solid
RefinedMesh refine(Mesh mesh, const RefineOptions& options = {}, const ViewSet& views = {},
                   const Monitor& monitor = {});

}  // namespace carve
