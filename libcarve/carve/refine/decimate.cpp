#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Constrained_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <stdexcept>
#include <string>

#include "carve/mesh/self_intersections.h"
#include "carve/refine/stages.h"
#include "carve/refine/surface_mesh.h"

namespace carve {
namespace {
namespace SMS = CGAL::Surface_mesh_simplification;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
using Policies = SMS::GarlandHeckbert_plane_policies<Surface, Kernel>;
using Edges = Surface::Property_map<Surface::Edge_index, bool>;
using Held = std::vector<std::uint8_t>;  // per vertex of the mesh

constexpr int kAttempts = 5;

Mesh collapsed(const Mesh& mesh, int faces, const Held& held) {
  Surface surface = refining::surface_mesh_of<Surface>(mesh);
  const Edges kept = surface.add_property_map<Surface::Edge_index, bool>("e:kept", false).first;
  for (const auto e : surface.edges()) kept[e] = held[surface.vertex(e, 0)] && held[surface.vertex(e, 1)];
  const Policies policies(surface);
  using Placement = Policies::Get_placement;
  const SMS::Constrained_placement<Placement, Edges> placement(kept, policies.get_placement());
  SMS::edge_collapse(surface, SMS::Count_stop_predicate<Surface>(static_cast<std::size_t>(faces) * 3 / 2),
                     CGAL::parameters::get_cost(policies.get_cost())
                         .get_placement(placement)
                         .edge_is_constrained_map(kept)
                         .filter(SMS::Bounded_normal_change_filter<>()));
  return refining::mesh_of(surface);
}

/// Holds the vertices of `mesh` in the boxes around triangles of `result` that pass through others.
bool hold_crossings(const Mesh& mesh, const Mesh& result, double margin, Held& held) {
  const auto pairs = self_intersections(result);
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const auto& [i, j] : pairs)
    for (const int t : {i, j}) {
      Eigen::AlignedBox3d box;
      for (const int v : result.triangles[t]) box.extend(result.positions[v]);
      const Vec3 grown = Vec3::Constant(margin * box.diagonal().norm());
      boxes.emplace_back(box.min() - grown, box.max() + grown);
    }
  for (std::size_t v = 0; v < held.size(); ++v)
    for (const auto& box : boxes)
      if (box.contains(mesh.positions[v])) held[v] = 1;
  return !pairs.empty();
}

}  // namespace

Mesh decimate(const Mesh& mesh, int faces) {
  if (faces < 4) throw std::invalid_argument("faces must be at least 4, got " + std::to_string(faces));
  if (mesh.triangles.size() <= static_cast<std::size_t>(faces)) return mesh;
  Held held(mesh.positions.size());
  Mesh result;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    result = collapsed(mesh, faces, held);
    if (!hold_crossings(mesh, result, 0.1 * attempt, held)) break;
  }
  return result;
}

}  // namespace carve
