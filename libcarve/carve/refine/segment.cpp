#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_approximation/approximate_triangle_mesh.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "carve/core/options.h"
#include "carve/refine/stages.h"
#include "carve/refine/surface_mesh.h"

namespace carve {
namespace {
using Surface = CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>;

constexpr int kIterations = 10;      // of the parts' growth
constexpr double kStiffness = 1e-2;  // how a vertex holds on to its place against its parts' planes
constexpr double kFarthest = 3;      // times flatness: vertices that would go farther stay

struct Plane {
  Vec3 normal = Vec3::Zero();  // zero where the part is not flat
  double offset = 0;
};

std::vector<std::size_t> part_of_triangles(const Mesh& mesh, int parts) {
  Surface surface = refining::surface_mesh_of<Surface>(mesh);
  const auto part = surface.add_property_map<Surface::Face_index, std::size_t>("f:part", 0).first;
  CGAL::Surface_mesh_approximation::approximate_triangle_mesh(
      surface, CGAL::parameters::seeding_method(CGAL::Surface_mesh_approximation::HIERARCHICAL)
                   .max_number_of_proxies(static_cast<std::size_t>(parts))
                   .number_of_iterations(kIterations)
                   .face_proxy_map(part));
  std::vector<std::size_t> result(mesh.triangles.size());
  for (std::size_t t = 0; t < result.size(); ++t) result[t] = part[Surface::Face_index(static_cast<unsigned>(t))];
  return result;
}

/// A plane through each part's centroid along its mean normal, where the part keeps to it.
std::vector<Plane> flat_planes(const Mesh& mesh, const std::vector<std::size_t>& part, double flatness) {
  const std::size_t parts = part.empty() ? 0 : *std::max_element(part.begin(), part.end()) + 1;
  std::vector<Plane> planes(parts);
  std::vector<Vec3> centroid(parts, Vec3::Zero());
  std::vector<double> area(parts), square(parts);
  const auto each = [&](auto&& use) {
    for (std::size_t t = 0; t < part.size(); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      const Vec3 &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
      use(part[t], Vec3((q - p).cross(r - p) / 2), Vec3((p + q + r) / 3));
    }
  };
  each([&](std::size_t i, const Vec3& vector_area, const Vec3& middle) {
    planes[i].normal += vector_area;
    centroid[i] += vector_area.norm() * middle;
    area[i] += vector_area.norm();
  });
  for (std::size_t i = 0; i < parts; ++i) {
    planes[i].normal.normalize();
    planes[i].offset = area[i] > 0 ? planes[i].normal.dot(centroid[i]) / area[i] : 0;
  }
  each([&](std::size_t i, const Vec3& vector_area, const Vec3& middle) {
    square[i] += vector_area.norm() * std::pow(planes[i].normal.dot(middle) - planes[i].offset, 2);
  });
  for (std::size_t i = 0; i < parts; ++i)
    if (square[i] > flatness * flatness * area[i]) planes[i] = {};
  return planes;
}

/// The point nearest to the planes, and a little to where it was.
Vec3 onto(const Vec3& from, const std::vector<const Plane*>& planes) {
  Eigen::Matrix3d normal = kStiffness * Eigen::Matrix3d::Identity();
  Vec3 rhs = Vec3::Zero();
  for (const Plane* plane : planes) {
    normal += plane->normal * plane->normal.transpose();
    rhs += plane->normal * (plane->offset - plane->normal.dot(from));
  }
  return from + normal.ldlt().solve(rhs);
}

}  // namespace

Mesh segment(const Mesh& mesh, const StageOptions& options) {
  check("refine", options);
  const std::vector<std::size_t> part = part_of_triangles(mesh, options.parts);
  const std::vector<Plane> planes = flat_planes(mesh, part, options.flatness);
  std::vector<std::vector<const Plane*>> at(mesh.positions.size());
  for (std::size_t t = 0; t < part.size(); ++t) {
    const Plane* plane = &planes[part[t]];
    if (plane->normal.isZero(0)) continue;
    for (const int v : mesh.triangles[t])
      if (std::find(at[v].begin(), at[v].end(), plane) == at[v].end()) at[v].push_back(plane);
  }
  Mesh result = mesh;
  for (std::size_t v = 0; v < at.size(); ++v) {
    const Vec3 place = onto(mesh.positions[v], at[v]);
    if ((place - mesh.positions[v]).norm() <= kFarthest * options.flatness) result.positions[v] = place;
  }
  return result;
}

}  // namespace carve
