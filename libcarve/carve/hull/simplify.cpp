#include "carve/hull/simplify.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_plus_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polyline_simplification_2/Stop_above_cost_threshold.h>
#include <CGAL/Polyline_simplification_2/simplify.h>

#include <algorithm>

namespace carve::hull {
namespace {

// Lattice points are exact in double, and so are CGAL's predicates of them.
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
namespace simplification = CGAL::Polyline_simplification_2;
using Vertex = simplification::Vertex_base_2<Kernel>;
using Face = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Delaunay = CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Vertex, Face>,
                                                            CGAL::Exact_predicates_tag>;
using Triangulation = CGAL::Constrained_triangulation_plus_2<Delaunay>;

/// The largest squared distance, in units of `scale`, from what was left out around a vertex to the side that would
/// replace its two; none for vertices on the border of the box.
struct ScaledDistance {
  std::array<double, 2> scale;
  std::array<std::int32_t, 2> low, high;

  boost::optional<double> operator()(const Triangulation&,
                                     const Triangulation::Vertices_in_constraint_iterator& at) const {
    const auto before = boost::prior(at), after = boost::next(at);
    for (int k = 0; k < 2; ++k)
      if (const double x = (*at)->point()[k]; x == low[k] || x == high[k]) return boost::none;
    const Kernel::Segment_2 side(scaled((*before)->point()), scaled((*after)->point()));
    double largest = 0;
    Triangulation::Points_in_constraint_iterator point(before);
    const Triangulation::Points_in_constraint_iterator last(after);
    for (++point; point != last; ++point) largest = std::max(largest, CGAL::squared_distance(side, scaled(*point)));
    return largest;
  }
  Kernel::Point_2 scaled(const Kernel::Point_2& p) const { return {p.x() / scale[0], p.y() / scale[1]}; }
};

}  // namespace

std::vector<LatticeLoop> simplified(const std::vector<LatticeLoop>& loops, double tolerance,
                                    const std::array<double, 2>& scale) {
  if (tolerance <= 0 || loops.empty()) return loops;
  ScaledDistance cost{scale, loops[0][0], loops[0][0]};
  for (const LatticeLoop& loop : loops)
    for (const LatticePoint& p : loop)
      for (int k = 0; k < 2; ++k) {
        cost.low[k] = std::min(cost.low[k], p[k]);
        cost.high[k] = std::max(cost.high[k], p[k]);
      }
  Triangulation triangulation;
  std::vector<Triangulation::Constraint_id> ids;
  for (const LatticeLoop& loop : loops) {
    std::vector<Kernel::Point_2> points;
    for (const LatticePoint& p : loop) points.emplace_back(p[0], p[1]);
    ids.push_back(triangulation.insert_constraint(points.begin(), points.end(), true));
  }
  simplification::simplify(triangulation, cost, simplification::Stop_above_cost_threshold(tolerance * tolerance));
  std::vector<LatticeLoop> result;
  for (const auto id : ids) {
    LatticeLoop loop;
    for (auto v = triangulation.vertices_in_constraint_begin(id); v != triangulation.vertices_in_constraint_end(id);
         ++v)
      loop.push_back({static_cast<std::int32_t>((*v)->point().x()), static_cast<std::int32_t>((*v)->point().y())});
    loop.pop_back();  // closed: the first again
    result.push_back(std::move(loop));
  }
  return result;
}

}  // namespace carve::hull
