#pragma once
#include <vector>

namespace carve {

/// Share of its convex hull that a convex set of voxels fills at least, for its voxels' corners.
inline constexpr double kConvex = 0.97;

/// The convex hull of voxels (or pixels) that are added row by row, the rows upwards.
class RowHull {
 public:
  /// Voxels u0 <= u < u1 of row v.
  void add(int v, int u0, int u1) {
    for (const int corner : {v, v + 1}) {
      extend(low_, {corner, u0}, 1);
      extend(high_, {corner, u1}, -1);
    }
  }
  double area() const { return under(high_) - under(low_); }

 private:
  struct Corner {
    int v, u;
  };
  static int turn(const Corner& a, const Corner& b, const Corner& c) {
    return (b.v - a.v) * (c.u - a.u) - (b.u - a.u) * (c.v - a.v);
  }
  static void extend(std::vector<Corner>& chain, const Corner& next, int side) {
    if (!chain.empty() && chain.back().v == next.v) {
      if (side * (next.u - chain.back().u) >= 0) return;
      chain.pop_back();
    }
    while (chain.size() > 1 && side * turn(chain[chain.size() - 2], chain.back(), next) <= 0) chain.pop_back();
    chain.push_back(next);
  }
  static double under(const std::vector<Corner>& chain) {
    double area = 0;
    for (std::size_t i = 1; i < chain.size(); ++i)
      area += (chain[i].v - chain[i - 1].v) * (chain[i].u + chain[i - 1].u) / 2.0;
    return area;
  }
  std::vector<Corner> low_, high_;
};

}  // namespace carve
