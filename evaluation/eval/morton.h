#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "carve/core/vector.h"

namespace carve {

/// The points' indices along a Morton curve through their bounding box (1024 steps an axis): neighbours in the order
/// are neighbours in space. Equal codes keep the points' own order. Points must be finite.
std::vector<std::int32_t> morton_order(std::span<const Vec3> points);

}  // namespace carve
