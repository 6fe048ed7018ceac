#pragma once
#include <span>

#include "carve/mesh/mesh.h"

namespace carve {

// What rounded arithmetic can prove of triangles, wherever their corners lie within `blur` of a coordinate; where it
// cannot the answer is the cautious one. Finite coordinates within 1e100.

/// Whether the triangles around a vertex (VertexTriangles), seen along some direction, lie side by side once around it:
/// then they meet only in what they share.
bool is_plain(const Mesh& mesh, std::span<const int> star, int vertex, double blur);

/// Whether two triangles surely meet nowhere but in the one corner that they may share.
bool are_apart(const Mesh& mesh, int i, int j, double blur);

/// The signs of the components of a triangle's normal; 0 where that cannot be told.
Vec3i faces(const Vec3& a, const Vec3& b, const Vec3& c, double blur);

/// How often the line through a point along an axis meets a triangle: not, once, or, if that cannot be told, 2.
int crossings(const Mesh& mesh, int triangle, const Vec3& point, int axis, double blur);

}  // namespace carve
