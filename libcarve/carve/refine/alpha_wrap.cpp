#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

#include "carve/core/options.h"
#include "carve/refine/stages.h"
#include "carve/refine/surface_mesh.h"

namespace carve {
namespace {
using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
constexpr double kOffset = 0.1;  // of wrap_detail
}  // namespace

Mesh alpha_wrap(const Mesh& mesh, const StageOptions& options) {
  check("refine", options);
  std::vector<Point> points;
  for (const Vec3& p : mesh.positions) points.emplace_back(p.x(), p.y(), p.z());
  CGAL::Surface_mesh<Point> wrap;
  CGAL::alpha_wrap_3(points, mesh.triangles, options.wrap_detail, kOffset * options.wrap_detail, wrap);
  return refining::mesh_of(wrap);
}

}  // namespace carve
