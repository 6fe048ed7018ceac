#pragma once
#include <memory>

#include "carve/mesh/mesh.h"

namespace carve {

/// A mesh prepared for rays (Embree, robust traversal; no display needed). Both sides of a triangle are hit. May be
/// asked from several threads; the answers do not depend on how many. \cite wald_2014
class RayScene {
 public:
  explicit RayScene(const Mesh& mesh);
  /// The triangle first met from `origin` in `direction` (unit length), -1 if none is.
  int first_hit(const Vec3& origin, const Vec3& direction) const;
  /// Nothing is met in (0, reach).
  bool clear(const Vec3& origin, const Vec3& direction, double reach) const;

 private:
  std::shared_ptr<void> scene_;
};

}  // namespace carve
