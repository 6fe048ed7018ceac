#include "carve/surface/contour_normals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "carve/core/parallel.h"

namespace carve {
namespace {

constexpr double kSmooth = std::numbers::pi / 6;  // a turn up to here may be the drawing's pixels
constexpr double kSame = 0.01;                    // radians: turns that do not differ

/// A crossing by its grid edge: along the first axis (kind 0) or the second (kind 1), ending at centre (i, j).
struct Node {
  int kind, i, j;
  bool operator==(const Node&) const = default;
};

class Chains {
 public:
  explicit Chains(const PlaneCrossings& crossings) : crossings_(crossings) {}

  float value(const Node& node) const {
    const Raster<float>& raster = node.kind == 0 ? crossings_.first : crossings_.second;
    return raster.contains(node.i, node.j) ? raster(node.i, node.j) : 0;
  }
  Vec2 place(const Node& node) const {
    const double at = value(node), share = at > 0 ? at : 1 + at;
    return node.kind == 0 ? Vec2(node.i - 1 + share, node.j) : Vec2(node.i, node.j - 1 + share);
  }

  PlaneNormals::Normal normal(const Node& node) const {
    const Vec2 here = place(node);
    const Side before = side(node, 0, here), after = side(node, 1, here);
    const double turn = before.length > 0 && after.length > 0 ? angle(-before.near, after.near) : 10;
    Vec2 tangent;
    if (turn <= std::min(before.turn, after.turn) + kSame)
      tangent =
          std::max(before.turn, after.turn) < kSmooth ? Vec2(after.far - before.far) : Vec2(after.near - before.near);
    else if (before.turn <= after.turn && before.length > 0)
      tangent = before.turn < kSmooth ? before.far : before.near;
    else if (after.length > 0)
      tangent = after.turn < kSmooth ? after.far : after.near;
    else
      return {};
    Vec2 across = Vec2(tangent.y(), -tangent.x()).normalized();
    if ((across[node.kind] > 0) != (value(node) > 0)) across = -across;
    constexpr double kGrazing = 0.02;
    if (!(std::abs(across[node.kind]) > kGrazing)) return {};
    return {static_cast<float>(across.x()), static_cast<float>(across.y())};
  }

 private:
  /// The chain on one side of a crossing, as ways from it to the next and the next but one.
  struct Side {
    int length = 0;
    Vec2 near = Vec2::Zero(), far = Vec2::Zero();
    double turn = 4;  // at the next one
  };

  static double angle(const Vec2& a, const Vec2& b) {
    return std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)));
  }

  Side side(const Node& node, int upper, const Vec2& here) const {
    Side result;
    Node from = node;
    int through = upper;
    for (; result.length < 2; ++result.length) {
      const auto next = step(from, through);
      if (!next) break;
      const Vec2 way = place(*next) - here;
      (result.length == 0 ? result.near : result.far) = way;
      // On through the cell on its other side.
      through = step(*next, 0) == from ? 1 : 0;
      from = *next;
    }
    if (result.length == 2) result.turn = angle(result.near, result.far - result.near);
    return result;
  }

  /// The next crossing through the cell on the lower (0) or the upper (1) side of a grid edge.
  std::optional<Node> step(const Node& node, int upper) const {
    const int i = node.kind == 1 ? node.i + upper : node.i, j = node.kind == 0 ? node.j + upper : node.j;
    const Node below{0, i, j - 1}, above{0, i, j}, left{1, i - 1, j}, right{1, i, j};
    Node other{-1, 0, 0};
    int crossed = 0;
    for (const Node& side : {below, above, left, right})
      if (value(side) != 0) {
        ++crossed;
        if (!(side == node)) other = side;
      }
    if (crossed == 2) return other;
    if (crossed != 4) return std::nullopt;
    // Two inside corners across: each is cut off.
    const bool lower_inside = value(node) > 0;
    return node.kind == 0 ? (lower_inside ? left : right) : (lower_inside ? below : above);
  }

  const PlaneCrossings& crossings_;
};

}  // namespace

PlaneNormals contour_normals(const PlaneCrossings& crossings) {
  const Chains chains(crossings);
  PlaneNormals result;
  const auto fill = [&](const Raster<float>& from, int kind, Raster<PlaneNormals::Normal>& to) {
    to = Raster<PlaneNormals::Normal>(from.width, from.height);
    parallel_ranges(0, from.height, 16, [&](int first, int last) {
      for (int j = first; j < last; ++j)
        for (int i = 0; i < from.width; ++i)
          if (from(i, j) != 0) to(i, j) = chains.normal({kind, i, j});
    });
  };
  fill(crossings.first, 0, result.first);
  fill(crossings.second, 1, result.second);
  return result;
}

}  // namespace carve
