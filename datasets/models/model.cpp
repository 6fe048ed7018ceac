#include "models/model.h"

#include <stdexcept>

namespace carve {

std::pair<Vec3, Vec3> bounds(const Mesh& mesh) {
  if (mesh.positions.empty()) throw std::invalid_argument("a model must have vertices, got none");
  Vec3 low = mesh.positions.front(), high = low;
  for (const Vec3& p : mesh.positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
  return {low, high};
}

Model placed(Model model) {
  const auto [low, high] = bounds(model.mesh);
  const double longest = (high - low).maxCoeff();
  if (!(longest > 0)) throw std::invalid_argument("a model must have an extent, got a point");
  const Vec3 origin((low.x() + high.x()) / 2, low.y(), (low.z() + high.z()) / 2);
  for (Vec3& p : model.mesh.positions) p = (p - origin) / longest;
  return model;
}

}  // namespace carve
