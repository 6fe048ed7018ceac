#include "hull/polygons.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

namespace carve {
namespace {

constexpr double kHalf = kLattice / 2;

class Random {
 public:
  explicit Random(unsigned seed) : generator_(seed) { generator_.discard(7); }
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(generator_()) / 4294967295.0;
  }

 private:
  std::mt19937 generator_;
};

LatticePoint around_middle(double radius, double angle) {
  return {static_cast<std::int32_t>(std::lround(kHalf + kHalf * radius * std::cos(angle))),
          static_cast<std::int32_t>(std::lround(kHalf + kHalf * radius * std::sin(angle)))};
}

}  // namespace

LatticeLoop star(int vertices, double low, double high, unsigned seed) {
  Random random(seed);
  LatticeLoop loop;
  for (int i = 0; i < vertices; ++i) {
    const double angle = 2 * std::numbers::pi * (i + random(0, 0.5)) / vertices;
    loop.push_back(around_middle(random(low, high), angle));
  }
  return loop;
}

LatticeLoop coarse_star(unsigned seed) {
  Random random(seed);
  std::map<double, LatticePoint> by_angle;  // one point a direction, so the outline is simple
  for (const LatticePoint corner : {LatticePoint{8, 0}, {0, 8}, {-8, 0}, {0, -8}})
    by_angle[std::atan2(corner[1], corner[0])] = corner;
  for (int i = 0; i < 16; ++i) {
    const int x = static_cast<int>(random(-8, 8.99)), y = static_cast<int>(random(-8, 8.99));
    if (std::max(std::abs(x), std::abs(y)) > 1) by_angle[std::atan2(y, x)] = {x, y};
  }
  LatticeLoop loop;
  for (const auto& [angle, p] : by_angle) loop.push_back({(p[0] + 8) * 4096, (p[1] + 8) * 4096});
  return loop;
}

LatticeLoop wave(int vertices, unsigned seed) {
  Random random(seed);
  const double turn = 2 * std::numbers::pi;
  const double phase[] = {random(0, turn), random(0, turn), random(0, turn)};
  LatticeLoop loop;
  for (int i = 0; i < vertices; ++i) {
    const double angle = turn * i / vertices;
    const double radius = 0.75 + 0.12 * std::sin(3 * angle + phase[0]) + 0.08 * std::sin(5 * angle + phase[1]) +
                          0.04 * std::sin(9 * angle + phase[2]);
    loop.push_back(around_middle(radius, angle));
  }
  return loop;
}

LatticeLoop reversed(LatticeLoop loop) {
  std::reverse(loop.begin(), loop.end());
  return loop;
}

LatticeLoop rectangle(std::int32_t x0, std::int32_t y0, std::int32_t x1, std::int32_t y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

Silhouettes random_silhouettes(unsigned seed) {
  Silhouettes all;
  for (int axis = 0; axis < 3; ++axis) {
    const unsigned own = 3 * seed + axis;
    Silhouette one{axis, View::front, {}};
    switch (seed % 5) {
      case 0:
        one.loops = {star(5 + seed % 23, 0.4, 1, own)};
        break;
      case 1:
        one.loops = {wave(8 + seed % 41, own)};
        break;
      case 2:
        one.loops = {star(9 + seed % 7, 0.6, 1, own), reversed(star(9, 0.2, 0.35, own + 1000)),
                     star(8, 0.05, 0.15, own + 2000)};
        break;
      case 3:
        one.loops = {coarse_star(own)};
        break;
      default:
        one.loops = {rectangle(0, 4096, kLattice, kLattice - 4096), reversed(coarse_star(own))};
        for (LatticePoint& p : one.loops[1])  // within the rectangle
          for (std::int32_t& x : p) x = kLattice / 4 + x / 2;
        break;
    }
    all.along.push_back(one);
  }
  return all;
}

Silhouettes box_silhouettes(const std::array<std::int32_t, 3>& low, const std::array<std::int32_t, 3>& high) {
  Silhouettes all;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    all.along.push_back({axis, View::front, {rectangle(low[u], low[v], high[u], high[v])}});
  }
  return all;
}

}  // namespace carve
