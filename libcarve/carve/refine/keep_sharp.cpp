// The stages that keep sharp edges, by CGAL: remesh, angle_and_area, tangential.
#define CGAL_PMP_USE_CERES_SOLVER
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/angle_and_area_smoothing.h>
#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Polygon_mesh_processing/tangential_relaxation.h>
#include <CGAL/Surface_mesh.h>

#include "carve/core/options.h"
#include "carve/refine/features.h"
#include "carve/refine/stages.h"
#include "carve/refine/surface_mesh.h"

namespace carve {
namespace {
namespace PMP = CGAL::Polygon_mesh_processing;
using Surface = CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>;

struct SharpSurface {
  Surface surface;
  Surface::Property_map<Surface::Edge_index, bool> sharp;
};

SharpSurface sharp_surface_of(const Mesh& mesh, const StageOptions& options) {
  SharpSurface result{refining::surface_mesh_of<Surface>(mesh), {}};
  result.sharp = result.surface.add_property_map<Surface::Edge_index, bool>("e:sharp", false).first;
  PMP::detect_sharp_edges(result.surface, options.feature, result.sharp);
  return result;
}

}  // namespace

Mesh remesh(const Mesh& mesh, const StageOptions& options) {
  check("refine", options);
  if (options.iterations == 0) return mesh;
  auto [surface, sharp] = sharp_surface_of(mesh, options);
  const double length = options.edge_length.value_or(refining::mean_edge_length(mesh));
  PMP::isotropic_remeshing(faces(surface), length, surface,
                           CGAL::parameters::number_of_iterations(static_cast<unsigned>(options.iterations))
                               .edge_is_constrained_map(sharp)
                               .relax_constraints(true));
  return refining::mesh_of(surface);
}

Mesh angle_and_area(const Mesh& mesh, const StageOptions& options) {
  check("refine", options);
  if (options.iterations == 0) return mesh;
  auto [surface, sharp] = sharp_surface_of(mesh, options);
  PMP::angle_and_area_smoothing(faces(surface), surface,
                                CGAL::parameters::number_of_iterations(static_cast<unsigned>(options.iterations))
                                    .edge_is_constrained_map(sharp)
                                    .use_Delaunay_flips(false));
  return refining::moved(mesh, surface);
}

Mesh tangential(const Mesh& mesh, const StageOptions& options) {
  check("refine", options);
  if (options.iterations == 0) return mesh;
  auto [surface, sharp] = sharp_surface_of(mesh, options);
  PMP::tangential_relaxation(vertices(surface), surface,
                             CGAL::parameters::number_of_iterations(static_cast<unsigned>(options.iterations))
                                 .edge_is_constrained_map(sharp)
                                 .relax_constraints(true));
  return refining::moved(mesh, surface);
}

}  // namespace carve
