#include "carve/texture/paint.h"

#include <algorithm>
#include <cmath>

#include "carve/mesh/neighbours.h"

namespace carve {

std::vector<Paint> paint_by_view(const ViewChoice& choice) {
  std::vector<Paint> paints(choice.projection.size());
  for (std::size_t t = 0; t < paints.size(); ++t) {
    const int view = choice.projections[choice.projection[t]].view;
    if (view >= 0) paints[t][0] = {view, 1};
  }
  return paints;
}

std::vector<Paint> paint_by_normal(const Mesh& mesh, const ViewSet& views, Mirror mirror) {
  const std::vector<Vec3> normals = triangle_normals(mesh);
  const bool sides = (views.find(View::side) != nullptr) != (views.find(View::left) != nullptr);
  std::vector<Paint> paints(normals.size());
  for (std::size_t t = 0; t < paints.size(); ++t) {
    double sum = 0;
    std::array<double, 3> weight{};
    for (int v = 0; v < static_cast<int>(views.views.size()); ++v) {
      const SignedAxis toward = frame(views.views[v].view).toward;
      double cosine = toward.sign * normals[t][toward.axis];
      if (toward.axis == 0 && sides && mirror != Mirror::no) cosine = std::abs(cosine);
      if (!(cosine > 0)) continue;
      // Of two drawings along one axis only one has a positive cosine.
      paints[t][toward.axis].view = v;
      sum += weight[toward.axis] = std::min(cosine, 1.0);
    }
    for (int axis = 0; axis < 3; ++axis)
      if (sum > 0) paints[t][axis].weight = static_cast<float>(weight[axis] / sum);
  }
  return paints;
}

}  // namespace carve
