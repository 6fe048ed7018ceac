#pragma once
// Internal to carve/texture.
#include <numeric>
#include <vector>

#include "carve/texture/atlas.h"

namespace carve {

/// Triangles in the order of their groups, each group's in rising order.
inline std::vector<int> sorted_by(const std::vector<int>& group, int groups) {
  std::vector<int> first(groups + 1), order(group.size());
  for (const int g : group) ++first[g + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  for (std::size_t t = 0; t < group.size(); ++t) order[first[group[t]]++] = static_cast<int>(t);
  return order;
}

/// Fills charts.uvs and charts.triangles: a vertex has one coordinate a chart, `place(triangle, vertex)` of the first
/// triangle that needs it.
template <class PlaceVertex>
void share_corners(const Mesh& mesh, Charts& charts, const PlaceVertex& place) {
  struct Last {
    int chart = -1, uv = 0;
  };
  std::vector<Last> last(mesh.positions.size());
  charts.uvs.clear();
  charts.triangles.resize(mesh.triangles.size());
  for (const int t : sorted_by(charts.chart, charts.count))
    for (int k = 0; k < 3; ++k) {
      const int v = mesh.triangles[t][k];
      if (last[v].chart != charts.chart[t]) {
        last[v] = {charts.chart[t], static_cast<int>(charts.uvs.size())};
        charts.uvs.push_back(place(t, v));
      }
      charts.triangles[t][k] = last[v].uv;
    }
}

}  // namespace carve
