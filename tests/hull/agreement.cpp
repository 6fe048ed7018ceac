#include "hull/agreement.h"

#include <cmath>
#include <optional>
#include <sstream>

#include "carve/core/error.h"
#include "carve/mesh/self_intersections.h"
#include "carve/mesh/topology.h"

namespace carve {

Agreement compare_methods(const Silhouettes& silhouettes) {
  Agreement result;
  std::ostringstream differences;
  std::optional<double> area;
  int results = 0;
  for (const HullMethod method : {HullMethod::strips, HullMethod::corefinement, HullMethod::nef}) {
    const char* name = names(method)[static_cast<int>(method)];
    PolyhedralHull hull;
    try {
      hull = polyhedral_hull(silhouettes, method, true);
    } catch (const NoResult& nothing) {
      result.not_representable |= std::string(nothing.what()).find("2-manifold") != std::string::npos;
      if (!result.not_representable || method != HullMethod::corefinement) result.empty = true;
      continue;
    }
    ++results;
    const Topology t = topology(hull.mesh);
    if (!t.solid() || t.degenerate_triangles != 0) differences << name << ": not a solid\n" << t;
    if (const auto pairs = self_intersections(hull.mesh); !pairs.empty())
      differences << name << ": " << pairs.size() << " self-intersections\n";
    if (result.volume.empty()) result.volume = hull.volume;
    if (hull.volume != result.volume)
      differences << name << ": volume " << hull.volume << ", not " << result.volume << '\n';
    if (!area) area = t.area;
    if (std::abs(t.area - *area) > 1e-12 * *area)
      differences << name << ": area " << t.area << ", not " << *area << '\n';
  }
  if (result.empty && results > 0) differences << "some of the methods found nothing\n";
  result.differences = differences.str();
  return result;
}

}  // namespace carve
