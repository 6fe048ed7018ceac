#pragma once
#include <map>
#include <string>
#include <vector>

#include "carve/carving/carve_silhouettes.h"
#include "carve/carving/consistency_report.h"
#include "carve/carving/convex_refinement.h"
#include "carve/carving/geometric_consistency.h"
#include "carve/core/monitor.h"
#include "carve/core/options.h"
#include "carve/hull/contours.h"
#include "carve/hull/polyhedral_hull.h"
#include "carve/mesh/topology.h"
#include "carve/refine/refine.h"
#include "carve/surface/smooth.h"
#include "carve/texture/texture.h"
#include "carve/views/read_drawings.h"

namespace carve {

/// Every option of the way from drawings to mesh; each is declared in its stage's header.
struct PipelineOptions {
  CarveOptions carve;
  bool intersections = true;
  bool intersections_strokes = true;
  bool intersections_sharp = true;
  HullMethod hull = HullMethod::none;
  ContourOptions contour;
  ConsistencyOptions consistency;
  ConvexOptions convex;
  DrawingOptions drawing;
  AlignOptions align;
  SmoothOptions smooth;
  RefineOptions refine;
  TextureOptions texture;  // automatic is none here: carve build knows what the output's format holds
  AtlasOptions atlas;
};

template <class Visitor>
void visit_fields(PipelineOptions& o, Visitor&& field) {
  field("intersections", o.intersections, "vertices at the exact crossing of grid line and drawn contour");
  field("intersections_strokes", o.intersections_strokes,
        "with intersections: what was carved along strokes ends in their middle instead of at voxels' faces");
  field("intersections_sharp", o.intersections_sharp,
        "with intersections: edges and corners at their place instead of cut off");
  field("hull", o.hull, "an exact polyhedral hull of the contours in place of voxels; it is not smoothed");
  field("faces", o.refine.faces, 4, 1e9, "triangles to leave, by edge collapse; auto: all");
}

/// All of them, for flags, TOML and records; the section is empty for carve's own ("grid"), else the stage
/// ("smooth.steps").
std::vector<Field> fields(PipelineOptions& options);

struct StageTime {
  std::string stage;
  double seconds = 0;
};

struct Reconstruction {
  Mesh mesh;       // solid (mesh/topology.h), object units: longest side 1, centred on x and z, standing on y = 0
  VoxelGrid grid;  // the solid the mesh was made from; of an exact hull, its voxels
  ConsistencyResult consistency;  // its grid is empty: it became `grid`; so are its crossings
  std::vector<RefinementStep> refinement;
  Topology topology;
  TexturedMesh textured;  // the mesh again with its texture; empty if there was to be none
  ViewSet views;
  std::vector<ViewAgreement> agreement;
  std::vector<StageTime> times;
};

/// The whole way: align, carve, consistency, convex, surface, smooth, refine, texture. With a hull method: align, carve
/// (to tell where the drawings disagree), hull, refine, texture.
/// \throws std::invalid_argument on options or views that cannot work; NoResult if nothing is left
Reconstruction reconstruct(std::map<View, Drawing> drawings, const PipelineOptions& options = {},
                           const Monitor& monitor = {});

}  // namespace carve
