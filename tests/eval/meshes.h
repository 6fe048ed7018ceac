#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "carve/mesh/mesh.h"

namespace carve {

// Small meshes with known answers, counter-clockwise from outside.

/// The unit cube around the origin, twelve triangles.
inline Mesh cube(const Vec3& centre = Vec3::Zero(), double side = 1) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back(centre + side * Vec3((i & 1) - 0.5, (i >> 1 & 1) - 0.5, (i >> 2) - 0.5));
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

/// A closed surface of revolution-like quads, `rings` from pole to pole; radius(polar, azimuth).
template <class Radius>
Mesh globe(int rings, int sectors, const Radius& radius) {
  Mesh mesh;
  const auto at = [&](int ring, int sector) {
    const double polar = std::numbers::pi * ring / rings, azimuth = 2 * std::numbers::pi * sector / sectors;
    return Vec3(radius(polar, azimuth) *
                Vec3(std::sin(polar) * std::sin(azimuth), std::cos(polar), std::sin(polar) * std::cos(azimuth)));
  };
  mesh.positions.push_back(at(0, 0));
  for (int ring = 1; ring < rings; ++ring)
    for (int sector = 0; sector < sectors; ++sector) mesh.positions.push_back(at(ring, sector));
  mesh.positions.push_back(at(rings, 0));
  const int last = static_cast<int>(mesh.positions.size()) - 1;
  const auto index = [&](int ring, int sector) { return 1 + (ring - 1) * sectors + sector % sectors; };
  for (int sector = 0; sector < sectors; ++sector) {
    mesh.triangles.push_back({0, index(1, sector), index(1, sector + 1)});
    for (int ring = 1; ring + 1 < rings; ++ring) {
      mesh.triangles.push_back({index(ring, sector), index(ring + 1, sector), index(ring, sector + 1)});
      mesh.triangles.push_back({index(ring, sector + 1), index(ring + 1, sector), index(ring + 1, sector + 1)});
    }
    mesh.triangles.push_back({index(rings - 1, sector), last, index(rings - 1, sector + 1)});
  }
  return mesh;
}

inline Mesh ball(int rings, double radius = 1) {
  return globe(rings, 2 * rings, [radius](double, double) { return radius; });
}

/// A ball with bumps, another for every seed.
inline Mesh potato(int rings, unsigned seed) {
  const int a = 2 + static_cast<int>(seed % 3), b = 1 + static_cast<int>(seed % 5);
  return globe(rings, 2 * rings, [=](double polar, double azimuth) {
    return 1 + 0.2 * std::sin(a * polar + seed) * std::sin(polar) * std::cos(b * azimuth);
  });
}

/// The square [0, 1]^2 at z = 0 in 2 n^2 triangles, facing +Z.
inline Mesh square(int n) {
  Mesh mesh;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) mesh.positions.emplace_back(x / double(n), y / double(n), 0);
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const int at = y * (n + 1) + x;
      mesh.triangles.push_back({at, at + 1, at + n + 2});
      mesh.triangles.push_back({at, at + n + 2, at + n + 1});
    }
  return mesh;
}

inline Vec3 random_point(std::mt19937& random, double reach = 1) {
  std::uniform_real_distribution<double> coordinate(-reach, reach);
  const double x = coordinate(random), y = coordinate(random);
  return {x, y, coordinate(random)};
}

/// Triangles of all shapes and sizes: slivers, needles, points, equal ones.
inline Mesh rubble(int count, unsigned seed) {
  std::mt19937 random(seed);
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const Vec3 a = random_point(random), side = random_point(random, std::pow(10.0, -static_cast<int>(random() % 6)));
    const double height = std::pow(10.0, -static_cast<int>(random() % 12));
    const Vec3 corners[] = {a, a + side, a + 0.3 * side + height * random_point(random)};
    const bool point = random() % 16 == 0;
    for (const Vec3& corner : corners) mesh.positions.push_back(point ? a : corner);
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    if (random() % 16 == 0) mesh.triangles.push_back(mesh.triangles.back());
  }
  return mesh;
}

inline Eigen::Isometry3d random_motion(unsigned seed) {
  std::mt19937 random(seed);
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.rotate(Eigen::AngleAxisd(1 + seed, random_point(random).normalized()));
  motion.pretranslate(random_point(random, 3));
  return motion;
}

template <class Map>
Mesh mapped(Mesh mesh, const Map& map) {
  for (Vec3& p : mesh.positions) p = map(p);
  return mesh;
}

inline Mesh joined(Mesh a, const Mesh& b) {
  const int offset = static_cast<int>(a.positions.size());
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  for (const auto& [i, j, k] : b.triangles) a.triangles.push_back({i + offset, j + offset, k + offset});
  return a;
}

inline Mesh turned_inside_out(Mesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

}  // namespace carve
