#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/smooth_shape.h>
#include <CGAL/Surface_mesh.h>

#include "carve/core/options.h"
#include "carve/refine/features.h"
#include "carve/refine/stages.h"
#include "carve/refine/surface_mesh.h"

namespace carve {
namespace {
using Surface = CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>;
}  // namespace

Mesh smooth_shape(const Mesh& mesh, const StageOptions& options) {
  check("refine", options);
  const double length = refining::mean_edge_length(mesh), time = options.shape_time.value_or(length * length);
  if (options.iterations == 0 || time == 0) return mesh;
  Surface surface = refining::surface_mesh_of<Surface>(mesh);
  const auto held = surface.add_property_map<Surface::Vertex_index, bool>("v:held", false).first;
  const auto features = refining::feature_sides(mesh, options.feature);
  for (std::size_t t = 0; t < features.size(); ++t)
    for (int k = 0; k < 3; ++k)
      if (features[t][k]) held[Surface::Vertex_index(mesh.triangles[t][k])] = true;
  CGAL::Polygon_mesh_processing::smooth_shape(
      faces(surface), surface, time,
      CGAL::parameters::number_of_iterations(static_cast<unsigned>(options.iterations))
          .vertex_is_constrained_map(held));
  return refining::moved(mesh, surface);
}

}  // namespace carve
