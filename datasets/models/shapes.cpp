// Shapes with known answers.
#include <cmath>
#include <numbers>

#include "models/primitives.h"
#include "models/procedural.h"
#include "models/shells.h"

namespace carve {
namespace {

constexpr Rgba kClay{201, 152, 110}, kSlate{108, 138, 168}, kSand{222, 202, 150};

// A box with one rectangular pocket a face: low/high corners in the face's own coordinates (u, v: the two axes after
// its axis), drawn as a closed shell of the box's outside and the pockets' walls.
struct Pocket {
  int axis;
  Vec2 low, high;
  double depth;
};

void quad(Mesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const int first = static_cast<int>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {a, b, c, d});
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

Vec3 corner(int axis, double along, double u, double v) {
  Vec3 p;
  p[axis] = along;
  p[(axis + 1) % 3] = u;
  p[(axis + 2) % 3] = v;
  return p;
}

// The face of a box towards +axis, with a pocket in it.
void pocket_face(Mesh& mesh, const Vec3& low, const Vec3& high, const Pocket& pocket) {
  const int a = pocket.axis;
  const double top = high[a], floor = top - pocket.depth;
  const double u[] = {low[(a + 1) % 3], pocket.low.x(), pocket.high.x(), high[(a + 1) % 3]};
  const double v[] = {low[(a + 2) % 3], pocket.low.y(), pocket.high.y(), high[(a + 2) % 3]};
  const auto outer = [&](int i, int j) { return corner(a, top, u[i ? 3 : 0], v[j ? 3 : 0]); };
  const auto rim = [&](int i, int j) { return corner(a, top, u[1 + i], v[1 + j]); };
  const auto deep = [&](int i, int j) { return corner(a, floor, u[1 + i], v[1 + j]); };
  constexpr int around[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
  for (int k = 0; k < 4; ++k) {
    const auto [i, j] = around[k];
    const auto [m, n] = around[k + 1];
    quad(mesh, outer(i, j), outer(m, n), rim(m, n), rim(i, j));
    quad(mesh, rim(i, j), rim(m, n), deep(m, n), deep(i, j));
  }
  quad(mesh, deep(0, 0), deep(1, 0), deep(1, 1), deep(0, 1));
}

void plain_face(Mesh& mesh, const Vec3& low, const Vec3& high, int axis) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  quad(mesh, corner(axis, low[axis], low[u], low[v]), corner(axis, low[axis], low[u], high[v]),
       corner(axis, low[axis], high[u], high[v]), corner(axis, low[axis], high[u], low[v]));
}

}  // namespace

Model plain_box() {
  Model model;
  add(model, "clay", kClay, box({-0.5, 0, -0.3}, {0.5, 0.7, 0.3}));
  return placed(std::move(model));
}

// Pockets of 5 %, 14 % and 30 % of the longest side in the side, the top and the front.
Model box_pockets() {
  const Vec3 low(-0.5, 0, -0.4), high(0.5, 0.8, 0.4);
  const Pocket pockets[] = {{0, {0.15, -0.2}, {0.55, 0.25}, 0.05},
                            {1, {-0.25, -0.35}, {0.2, 0.1}, 0.14},
                            {2, {-0.3, 0.12}, {0.05, 0.5}, 0.30}};
  Mesh mesh;
  for (const Pocket& pocket : pockets) {
    pocket_face(mesh, low, high, pocket);
    plain_face(mesh, low, high, pocket.axis);
  }
  Model model;
  add(model, "slate", kSlate, welded(mesh));
  return placed(std::move(model));
}

// Its inner wall is upright for the first 8 % below the rim, so that the rim is a stroke in the top view.
Model bowl() {
  std::vector<Vec2> profile{{0, 0}, {0.24, 0}};
  const auto arc = [&](double radius, double centre, double from, double to) {
    for (int i = 0; i <= 40; ++i) {
      const double angle = (from + (to - from) * i / 40) * std::numbers::pi / 180;
      profile.emplace_back(radius * std::sin(angle), centre - radius * std::cos(angle));
    }
  };
  arc(0.5, 0.45, 30, 90);
  profile.emplace_back(0.5, 0.55);
  profile.emplace_back(0.43, 0.55);
  arc(0.43, 0.47, 90, 2);
  profile.emplace_back(0, profile.back().y());
  Model model;
  add(model, "sand", kSand, lathe(profile, 96));
  return placed(std::move(model));
}

Model sphere() {
  Model model;
  add(model, "clay", kClay, ellipsoid({0, 0.5, 0}, {0.5, 0.5, 0.5}, 192));
  return placed(std::move(model));
}

Model ring() {
  Model model;
  add(model, "sand", kSand, torus({0, 0, 0}, 2, 0.36, 0.14, 160));
  return placed(std::move(model));
}

}  // namespace carve
