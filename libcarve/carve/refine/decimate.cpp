#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Constrained_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

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
using Pairs = std::vector<std::pair<int, int>>;
using Held = std::vector<std::uint8_t>;  // per vertex of the mesh

constexpr int kAttempts = 3;         // to hold what would pass through itself
constexpr double kLeastStep = 0.95;  // of the triangles: what a step leaves, at most

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
void hold_crossings(const Mesh& mesh, const Mesh& result, const Pairs& crossings, double margin, Held& held) {
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const auto& [i, j] : crossings)
    for (const int t : {i, j}) {
      Eigen::AlignedBox3d box;
      for (const int v : result.triangles[t]) box.extend(result.positions[v]);
      const Vec3 grown = Vec3::Constant(margin * box.diagonal().norm());
      boxes.emplace_back(box.min() - grown, box.max() + grown);
    }
  for (std::size_t v = 0; v < held.size(); ++v)
    for (const auto& box : boxes)
      if (box.contains(mesh.positions[v])) held[v] = 1;
}

/// With at most `allowed` pairs of triangles that pass through each other; else nothing.
std::optional<Mesh> collapsed_without_crossings(const Mesh& mesh, int faces, std::size_t allowed) {
  Held held(mesh.positions.size());
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    Mesh result = collapsed(mesh, faces, held);
    const Pairs crossings = self_intersections(result);
    if (crossings.size() <= allowed) return result;
    hold_crossings(mesh, result, crossings, 0.1 * attempt, held);
  }
  return std::nullopt;
}

}  // namespace

Mesh decimate(const Mesh& mesh, int faces) {
  if (faces < 4) throw std::invalid_argument("faces must be at least 4, got " + std::to_string(faces));
  const std::size_t allowed = self_intersections(mesh).size();
  Mesh result = mesh;
  // All at once, which keeps the quadrics; in steps where that fails, so that the first ones are done at least.
  double share = faces / static_cast<double>(mesh.triangles.size());
  while (result.triangles.size() > static_cast<std::size_t>(faces) && share < kLeastStep) {
    const int fewer = std::max(faces, static_cast<int>(share * static_cast<double>(result.triangles.size())));
    auto next = collapsed_without_crossings(result, fewer, allowed);
    if (next && next->triangles.size() < result.triangles.size()) {
      result = std::move(*next);
    } else {
      share = std::max(0.5, (1 + share) / 2);
    }
  }
  return result;
}

}  // namespace carve
