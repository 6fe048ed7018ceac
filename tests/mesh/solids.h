#pragma once
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <utility>

#include "carve/mesh/mesh.h"

namespace carve {

inline Mesh tetrahedron_mesh() {
  return {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

/// Corner i is at bit 0 of i in x, bit 1 in y, bit 2 in z.
inline Mesh cube_mesh() {
  Mesh cube;
  for (int i = 0; i < 8; ++i) cube.positions.emplace_back(i & 1, i >> 1 & 1, i >> 2);
  const int quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& q : quads) {
    cube.triangles.push_back({q[0], q[1], q[2]});
    cube.triangles.push_back({q[0], q[2], q[3]});
  }
  return cube;
}

/// 2 * around * across triangles.
inline Mesh torus_mesh(int around = 24, int across = 12, double radius = 0.35, double tube = 0.15) {
  Mesh mesh;
  const double turn = 2 * std::numbers::pi;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double u = turn * i / around, v = turn * j / across, r = radius + tube * std::cos(v);
      mesh.positions.emplace_back(r * std::cos(u), tube * std::sin(v), -r * std::sin(u));
      const int a = i * across + j, b = i * across + (j + 1) % across;
      const int c = (i + 1) % around * across + j, d = (i + 1) % around * across + (j + 1) % across;
      mesh.triangles.push_back({a, c, d});
      mesh.triangles.push_back({a, d, b});
    }
  return mesh;
}

/// The octahedron, every triangle split in four `times` times, on the unit sphere.
inline Mesh ball_mesh(int times = 3) {
  Mesh mesh{{Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)},
            {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  for (; times > 0; --times) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [found, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<int>(mesh.positions.size()));
      if (is_new) mesh.positions.push_back((mesh.positions[a] + mesh.positions[b]).normalized());
      return found->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = finer;
  }
  return mesh;
}

/// The unit cube with each face a grid of n by n squares.
inline Mesh grid_box(int n) {
  Mesh box;
  std::map<std::array<int, 3>, int> known;
  const auto vertex = [&](std::array<int, 3> at) {
    const auto [found, is_new] = known.try_emplace(at, static_cast<int>(box.positions.size()));
    if (is_new) box.positions.push_back(Vec3(at[0], at[1], at[2]) / n);
    return found->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const int end : {0, n})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto corner = [&](int u, int v) {
            std::array<int, 3> at{};
            at[axis] = end, at[(axis + 1) % 3] = i + u, at[(axis + 2) % 3] = j + v;
            return vertex(at);
          };
          const int a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          if (end == 0)
            box.triangles.insert(box.triangles.end(), {{a, c, b}, {a, d, c}});
          else
            box.triangles.insert(box.triangles.end(), {{a, b, c}, {a, c, d}});
        }
  return box;
}

/// Both meshes as one, sharing nothing.
inline Mesh together(Mesh a, const Mesh& b) {
  const int base = static_cast<int>(a.positions.size());
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  for (const auto& [i, j, k] : b.triangles) a.triangles.push_back({i + base, j + base, k + base});
  return a;
}

/// Every position moved by up to `distance` along each axis.
inline Mesh shaken(Mesh mesh, unsigned seed, double distance) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shift(-distance, distance);
  for (Vec3& p : mesh.positions) p += Vec3(shift(random), shift(random), shift(random));
  return mesh;
}

/// A closed surface with odd coordinates: seed picks shape, noise and scale.
inline Mesh random_solid(unsigned seed) {
  std::mt19937 random(seed);
  Mesh mesh = seed % 3 == 0   ? ball_mesh(1 + static_cast<int>(random() % 3))
              : seed % 3 == 1 ? torus_mesh(3 + static_cast<int>(random() % 20), 3 + static_cast<int>(random() % 20))
                              : together(cube_mesh(), tetrahedron_mesh());
  const double scale = std::pow(10.0, static_cast<int>(random() % 7) - 3);
  mesh = shaken(mesh, seed, 0.01);
  for (Vec3& p : mesh.positions) p *= scale;
  return mesh;
}

}  // namespace carve
