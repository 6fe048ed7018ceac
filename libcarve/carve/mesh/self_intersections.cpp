#include "carve/mesh/self_intersections.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Intersections_3/Segment_3_Triangle_3.h>
#include <CGAL/Intersections_3/Triangle_3_Triangle_3.h>

#include <algorithm>
#include <array>

#include "carve/core/parallel.h"
#include "carve/mesh/bvh.h"

namespace carve {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

struct Box3f {
  std::array<float, 3> low, high;
};

class Finder {
 public:
  explicit Finder(const Mesh& mesh) : mesh_(mesh), bvh_(build_bvh(mesh)), points_(mesh.positions.size()) {
    for (std::size_t i = 0; i < points_.size(); ++i)
      points_[i] = {mesh.positions[i].x(), mesh.positions[i].y(), mesh.positions[i].z()};
    degenerate_.resize(mesh.triangles.size());
    for (std::size_t t = 0; t < degenerate_.size(); ++t) degenerate_[t] = shape(t).is_degenerate();
  }

  // Partners j > i of triangle i, in order.
  std::vector<int> partners(int i) const {
    std::vector<int> found;
    if (degenerate_[i]) return found;
    const Box3f box = box_of(i);
    std::array<std::int32_t, Bvh::kStack> stack;
    int top = 0;
    stack[top++] = 0;
    while (top > 0) {
      const std::int32_t at = stack[--top];
      if (at < 0) {
        for (int k = 0; k < Bvh::kWidth; ++k) {
          const int j = bvh_.slots[~at * Bvh::kWidth + k];
          if (j > i && !degenerate_[j] && meet(i, j)) found.push_back(j);
        }
        continue;
      }
      const BvhNode& node = bvh_.nodes[at];
      for (int k = 0; k < Bvh::kWidth; ++k) {
        bool apart = false;
        for (int axis = 0; axis < 3; ++axis)
          apart |= node.low[axis][k] > box.high[axis] || node.high[axis][k] < box.low[axis];
        if (!apart) stack[top++] = node.child[k];
      }
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());  // leaves repeat their last triangle
    return found;
  }

 private:
  Kernel::Triangle_3 shape(std::size_t t) const {
    const auto [a, b, c] = mesh_.triangles[t];
    return {points_[a], points_[b], points_[c]};
  }

  Box3f box_of(int t) const {
    Box3f box;
    const auto [a, b, c] = mesh_.triangles[t];
    const Vec3 pa = bvh_.inside(mesh_.positions[a]), pb = bvh_.inside(mesh_.positions[b]),
               pc = bvh_.inside(mesh_.positions[c]);
    for (int k = 0; k < 3; ++k) {  // rounded outwards by more than a float's last place in [-1, 1]
      box.low[k] = static_cast<float>(std::min({pa[k], pb[k], pc[k]}) - 1e-6);
      box.high[k] = static_cast<float>(std::max({pa[k], pb[k], pc[k]}) + 1e-6);
    }
    return box;
  }

  bool meet(int i, int j) const {
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
      const Kernel::Segment_3 far_a(points_[a[1]], points_[a[2]]), far_b(points_[b[1]], points_[b[2]]);
      return CGAL::do_intersect(shape(i), far_b) || CGAL::do_intersect(shape(j), far_a);
    }
    return CGAL::do_intersect(shape(i), shape(j));
  }

  // Triangles with a common side overlap where they lie in one plane on one side of it.
  bool folded(const std::array<int, 3>& a, const std::array<int, 3>& b) const {
    const Point &p = points_[a[0]], &q = points_[a[1]], &r = points_[a[2]], &s = points_[b[2]];
    return CGAL::coplanar(p, q, r, s) && CGAL::coplanar_orientation(p, q, r, s) == CGAL::POSITIVE;
  }

  const Mesh& mesh_;
  const Bvh bvh_;
  std::vector<Point> points_;
  std::vector<bool> degenerate_;
};

}  // namespace

std::vector<std::pair<int, int>> self_intersections(const Mesh& mesh) {
  const Finder finder(mesh);
  std::vector<std::vector<int>> partners(mesh.triangles.size());
  parallel_ranges(0, static_cast<int>(partners.size()), 1024, [&](int first, int last) {
    for (int i = first; i < last; ++i) partners[i] = finder.partners(i);
  });
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t i = 0; i < partners.size(); ++i)
    for (const int j : partners[i]) pairs.emplace_back(static_cast<int>(i), j);
  return pairs;
}

}  // namespace carve
