#pragma once
#include <Eigen/Core>

namespace carve {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Vec3i = Eigen::Vector3i;

}  // namespace carve
