#pragma once
#include <array>
#include <span>
#include <vector>

#include "carve/core/vector.h"

namespace carve::artist {

/// Cuts a simple polygon, nearly plane and possibly not convex, into n - 2 triangles of its corners' indices that keep
/// its orientation (ears are clipped in the plane of the polygon's mean normal; a convex polygon becomes a fan).
std::vector<std::array<int, 3>> triangulate(std::span<const Vec3> outline);

}  // namespace carve::artist
