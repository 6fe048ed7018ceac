#include "carve/hull/exact_hull.h"

#include <gmpxx.h>

#include <map>

namespace carve::hull {

std::vector<ContourEdge> contour_edges(const Silhouettes& silhouettes) {
  std::vector<ContourEdge> edges;
  for (int k = 0; k < static_cast<int>(silhouettes.along.size()); ++k) {
    const auto& loops = silhouettes.along[k].loops;
    for (int l = 0; l < static_cast<int>(loops.size()); ++l)
      for (int i = 0; i < static_cast<int>(loops[l].size()); ++i)
        edges.push_back({k, l, i, loops[l][i], loops[l][(i + 1) % loops[l].size()]});
  }
  return edges;
}

SweptPlanes swept_planes(const Silhouettes& silhouettes, std::span<const ContourEdge> edges) {
  SweptPlanes swept;
  std::map<std::array<std::int32_t, 3>, int> shared;  // axis, direction, place
  for (const ContourEdge& e : edges) {
    const int w = silhouettes.along[e.silhouette].axis, u = (w + 1) % 3, v = (w + 2) % 3;
    const std::int64_t du = e.to[0] - e.from[0], dv = e.to[1] - e.from[1];
    FacetPlane plane{};
    plane.normal[u] = dv;
    plane.normal[v] = -du;
    int index = static_cast<int>(swept.planes.size());
    if (du == 0) index = shared.try_emplace({u, dv > 0, e.from[0]}, index).first->second;
    if (dv == 0) index = shared.try_emplace({v, du < 0, e.from[1]}, index).first->second;
    if (index == static_cast<int>(swept.planes.size())) swept.planes.push_back(plane);
    swept.of_edge.push_back(index);
  }
  return swept;
}

std::string exact_volume(const std::vector<ExactPoint>& points, std::span<const FacetSide> sides,
                         std::span<const std::array<int, 3>> triangles) {
  const auto coordinate = [&](int corner, int axis) {
    const ExactPoint& p = points[sides[corner].from];
    const auto integer = [](std::int64_t x) { return mpz_class(static_cast<signed long>(x)); };
    mpq_class x(integer(p.rest[axis]), integer(p.den));
    x.canonicalize();
    return mpq_class(x + p.whole[axis]);
  };
  // Terms are added in pairs of pairs: denominators grow with every sum.
  std::vector<mpq_class> sums;
  std::vector<int> count;
  for (const auto& [a, b, c] : triangles) {
    const mpq_class ax = coordinate(a, 0), ay = coordinate(a, 1);
    const mpq_class area =
        (coordinate(b, 0) - ax) * (coordinate(c, 1) - ay) - (coordinate(c, 0) - ax) * (coordinate(b, 1) - ay);
    if (area == 0) continue;
    sums.push_back(area * (coordinate(a, 2) + coordinate(b, 2) + coordinate(c, 2)));
    count.push_back(1);
    while (count.size() > 1 && count.back() == count[count.size() - 2]) {
      sums[sums.size() - 2] += sums.back();
      count[count.size() - 2] *= 2;
      sums.pop_back(), count.pop_back();
    }
  }
  mpq_class total = 0;
  for (auto sum = sums.rbegin(); sum != sums.rend(); ++sum) total += *sum;
  return mpq_class(total / 6).get_str();
}

}  // namespace carve::hull
