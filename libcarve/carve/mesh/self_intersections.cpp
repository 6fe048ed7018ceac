#include "carve/mesh/self_intersections.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Intersections_3/Segment_3_Triangle_3.h>
#include <CGAL/Intersections_3/Triangle_3_Triangle_3.h>

#include <algorithm>
#include <array>
#include <limits>

#include "carve/core/as_floats.h"
#include "carve/core/parallel.h"
#include "carve/mesh/near_pairs.h"

namespace carve {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

class Exactly {
 public:
  explicit Exactly(const Mesh& mesh, bool as_floats = false) : mesh_(mesh), as_floats_(as_floats) {}

  bool meet(int i, int j) const {
    const Kernel::Triangle_3 first = shape(mesh_.triangles[i]), second = shape(mesh_.triangles[j]);
    if (first.is_degenerate() || second.is_degenerate()) return false;
    // The corners of both, shared ones first and in the same order.
    std::array<int, 3> a = mesh_.triangles[i], b = mesh_.triangles[j];
    int shared = 0;
    for (int k = 0; k < 3; ++k) {
      const auto match = std::find(b.begin() + shared, b.end(), a[k]);
      if (match == b.end()) continue;
      std::swap(*match, b[shared]);
      std::swap(a[k], a[shared]);
      ++shared;
    }
    if (shared == 3) return true;
    if (shared == 2) return folded(a, b);
    if (shared == 1) {
      const Kernel::Segment_3 far_a(point(a[1]), point(a[2])), far_b(point(b[1]), point(b[2]));
      return CGAL::do_intersect(first, far_b) || CGAL::do_intersect(second, far_a);
    }
    return CGAL::do_intersect(first, second);
  }

 private:
  Point point(int v) const {
    const Vec3 p = as_floats_ ? as_floats(mesh_.positions[v]) : mesh_.positions[v];
    return {p.x(), p.y(), p.z()};
  }
  Kernel::Triangle_3 shape(const Triangle& t) const { return {point(t[0]), point(t[1]), point(t[2])}; }

  // Triangles with a common side overlap where they lie in one plane on one side of it.
  bool folded(const std::array<int, 3>& a, const std::array<int, 3>& b) const {
    const Point p = point(a[0]), q = point(a[1]), r = point(a[2]), s = point(b[2]);
    return CGAL::coplanar(p, q, r, s) && CGAL::coplanar_orientation(p, q, r, s) == CGAL::POSITIVE;
  }

  const Mesh& mesh_;
  const bool as_floats_;
};

/// By how much rounding to floats may move a coordinate.
double blur(double largest) { return largest * std::numeric_limits<float>::epsilon(); }

std::vector<std::pair<int, int>> those_that_meet(const Mesh& mesh, std::vector<std::pair<int, int>> pairs,
                                                 bool as_floats) {
  const Exactly exactly(mesh), as_written(mesh, true);
  std::vector<std::uint8_t> meeting(pairs.size());
  parallel_ranges(0, static_cast<int>(pairs.size()), 256, [&](int first, int last) {
    for (int k = first; k < last; ++k) {
      const auto [i, j] = pairs[k];
      meeting[k] = exactly.meet(i, j) || (as_floats && as_written.meet(i, j));
    }
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (meeting[i]) pairs[kept++] = pairs[i];
  pairs.resize(kept);
  return pairs;
}

}  // namespace

std::vector<std::pair<int, int>> self_intersections(const Mesh& mesh) {
  return self_intersections(mesh, vertex_triangles(mesh));
}

std::vector<std::pair<int, int>> self_intersections(const Mesh& mesh, const VertexTriangles& around,
                                                    std::span<const std::uint8_t> moved, bool as_floats) {
  double largest = 0;
  if (as_floats)
    for (const Vec3& p : mesh.positions) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  return those_that_meet(mesh, near_pairs(mesh, around, moved, blur(largest)), as_floats);
}

std::vector<std::pair<int, int>> self_intersections(const Mesh& mesh, const VertexTriangles& around,
                                                    const TriangleGrid& grid, std::span<const int> vertices,
                                                    bool as_floats) {
  return those_that_meet(mesh, near_pairs(mesh, around, grid, vertices, as_floats ? blur(grid.largest()) : 0),
                         as_floats);
}

std::vector<std::pair<int, int>> contacts(const Mesh& mesh, std::span<const std::pair<int, int>> meeting) {
  using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
  const auto shape = [&](const Triangle& t) {
    const auto point = [&](int v) {
      const Vec3& p = mesh.positions[v];
      return Exact::Point_3(p.x(), p.y(), p.z());
    };
    return Exact::Triangle_3(point(t[0]), point(t[1]), point(t[2]));
  };
  std::vector<std::pair<int, int>> found;
  for (const auto& [i, j] : meeting) {
    const Triangle &a = mesh.triangles[i], &b = mesh.triangles[j];
    if (std::ranges::any_of(a, [&](int v) { return std::ranges::count(b, v) > 0; })) continue;
    const auto common = CGAL::intersection(shape(a), shape(b));
    if (common && boost::get<Exact::Point_3>(&*common)) found.emplace_back(i, j);
  }
  return found;
}

}  // namespace carve
