#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/smooth_shape.h>
#include <CGAL/Surface_mesh.h>

#include <Eigen/Geometry>
#include <cstdint>

#include "carve/core/options.h"
#include "carve/mesh/topology.h"
#include "carve/refine/features.h"
#include "carve/refine/stages.h"
#include "carve/refine/surface_mesh.h"

namespace carve {
namespace {
using Surface = CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>;

/// Gives a mesh its volume back by an even offset of the vertices that are not held, along their normals.
void restore_volume(Mesh& mesh, double volume, const std::vector<std::uint8_t>& held) {
  constexpr int kSteps = 4;  // of Newton's method
  for (int step = 0; step < kSteps; ++step) {
    double now = 0;
    std::vector<Vec3> areas(mesh.positions.size(), Vec3::Zero());  // of the triangles around, a third of each
    for (const auto& [a, b, c] : mesh.triangles) {
      const Vec3 &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
      const Vec3 normal = (q - p).cross(r - p);
      now += p.dot(q.cross(r)) / 6;
      for (const int v : {a, b, c}) areas[v] += normal / 6;
    }
    double area = 0;
    for (std::size_t v = 0; v < areas.size(); ++v)
      if (!held[v]) area += areas[v].norm();
    if (!(area > 0)) return;
    for (std::size_t v = 0; v < areas.size(); ++v)
      if (!held[v]) mesh.positions[v] += (volume - now) / area * areas[v].stableNormalized();
  }
}

}  // namespace

Mesh smooth_shape(const Mesh& mesh, const StageOptions& options) {
  check("refine", options);
  const double length = refining::mean_edge_length(mesh), time = options.shape_time.value_or(length * length);
  if (options.iterations == 0 || time == 0) return mesh;
  Surface surface = refining::surface_mesh_of<Surface>(mesh);
  std::vector<std::uint8_t> stays(mesh.positions.size());
  const auto held = surface.add_property_map<Surface::Vertex_index, bool>("v:held", false).first;
  const auto features = refining::feature_sides(mesh, options.feature);
  for (std::size_t t = 0; t < features.size(); ++t)
    for (int k = 0; k < 3; ++k)
      if (features[t][k]) stays[mesh.triangles[t][k]] = 1;
  for (const auto v : surface.vertices()) held[v] = stays[v] != 0;
  CGAL::Polygon_mesh_processing::smooth_shape(
      faces(surface), surface, time,
      CGAL::parameters::number_of_iterations(static_cast<unsigned>(options.iterations))
          .vertex_is_constrained_map(held));
  Mesh flowed = refining::moved(mesh, surface);
  restore_volume(flowed, topology(mesh).volume, stays);
  return flowed;
}

}  // namespace carve
