#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/tangential_relaxation.h>
#include <CGAL/Surface_mesh.h>

#include "carve/core/options.h"
#include "carve/refine/stages.h"
#include "carve/refine/surface_mesh.h"

namespace carve {
namespace {
namespace PMP = CGAL::Polygon_mesh_processing;
using Surface = CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>;
}  // namespace

Mesh tangential(const Mesh& mesh, const StageOptions& options) {
  check("refine", options);
  if (options.iterations == 0) return mesh;
  Surface surface = refining::surface_mesh_of<Surface>(mesh);
  const auto features = surface.add_property_map<Surface::Edge_index, bool>("e:feature", false).first;
  PMP::detect_sharp_edges(surface, options.feature, features);
  PMP::tangential_relaxation(vertices(surface), surface,
                             CGAL::parameters::number_of_iterations(static_cast<unsigned>(options.iterations))
                                 .edge_is_constrained_map(features)
                                 .relax_constraints(true));
  return refining::moved(mesh, surface);
}

}  // namespace carve
