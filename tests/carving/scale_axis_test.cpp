#include "carve/carving/scale_axis.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "carve/core/parallel.h"

namespace carve {
namespace {

/// The voxels whose centres, in voxels from the middle of the grid, are inside.
template <class Inside>
VoxelGrid solid(const Vec3i& size, Inside&& inside) {
  VoxelGrid grid(size, Vec3::Zero(), 1);
  for (int z = 0; z < size.z(); ++z)
    for (int y = 0; y < size.y(); ++y)
      for (int x = 0; x < size.x(); ++x)
        grid.set(x, y, z, inside(Vec3(Vec3(x + 0.5, y + 0.5, z + 0.5) - size.cast<double>() / 2)));
  return grid;
}

std::vector<float> values(const VoxelGrid& grid, double scale) {
  const ScaleAxis balls(grid, scale);
  std::vector<float> all, layer;
  for (int z = 0; z < grid.size().z(); ++z) {
    balls.layer(z, layer);
    all.insert(all.end(), layer.begin(), layer.end());
  }
  return all;
}

/// What stays of the solid.
VoxelGrid rounded(const VoxelGrid& grid, double scale) {
  VoxelGrid out = grid;
  const std::vector<float> out_of_it = values(grid, scale);
  std::size_t i = 0;
  for (int z = 0; z < grid.size().z(); ++z)
    for (int y = 0; y < grid.size().y(); ++y)
      for (int x = 0; x < grid.size().x(); ++x, ++i)
        if (out_of_it[i] > 1) out.set(x, y, z, false);
  return out;
}

double share_that_stays(const VoxelGrid& grid, double scale) {
  return static_cast<double>(rounded(grid, scale).count()) / static_cast<double>(grid.count());
}

VoxelGrid ball(int size) {
  return solid(Vec3i::Constant(size), [&](const Vec3& p) { return p.norm() < 0.45 * size; });
}
VoxelGrid box(int size) {
  return solid(Vec3i::Constant(size), [&](const Vec3& p) { return p.cwiseAbs().maxCoeff() < 0.4 * size; });
}
/// A cone of that half angle in degrees, its tip up.
VoxelGrid cone(double half_angle) {
  const double slope = std::tan(half_angle * std::numbers::pi / 180);
  return solid({96, 96, 96}, [&](const Vec3& p) {
    return p.y() > -40 && p.y() < 40 && std::hypot(p.x(), p.z()) < std::min(44.0, slope * (40 - p.y()));
  });
}

/// Overlapping ellipsoids and boxes. \param mirrored  left to right
VoxelGrid bodies(unsigned seed, bool mirrored = false) {
  std::mt19937 random(seed);
  const auto between = [&](double a, double b) { return a + (b - a) * (random() % 1000) / 1000; };
  const Vec3i size(40 + static_cast<int>(random() % 100), 50 + static_cast<int>(random() % 30), 45);
  std::vector<std::array<Vec3, 2>> all;
  std::vector<bool> boxes;
  for (int n = 3 + static_cast<int>(random() % 4); n > 0; --n) {
    Vec3 centre, radii;
    for (int a = 0; a < 3; ++a) centre[a] = between(-0.25, 0.25) * size[a], radii[a] = between(0.1, 0.25) * size[a];
    all.push_back({centre, radii});
    boxes.push_back(random() % 3 == 0);
  }
  return solid(size, [&](Vec3 p) {
    if (mirrored) p.x() = -p.x();
    for (std::size_t k = 0; k < all.size(); ++k) {
      const Vec3 out = (p - all[k][0]).cwiseQuotient(all[k][1]).cwiseAbs();
      if ((boxes[k] ? out.maxCoeff() : out.norm()) < 1) return true;
    }
    return false;
  });
}

class ScaleAxisTest : public ::testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, ScaleAxisTest, ::testing::Range(0u, 16u));

TEST_P(ScaleAxisTest, AtScaleOneHardlyAVoxelGoes) { EXPECT_GT(share_that_stays(bodies(GetParam()), 1), 0.985); }

TEST_P(ScaleAxisTest, ALargerScaleRoundsMore) {
  const VoxelGrid grid = bodies(GetParam());
  const VoxelGrid little = rounded(grid, 1.4), much = rounded(grid, 3);
  EXPECT_TRUE(contains(little, much));
  EXPECT_LT(much.count(), little.count());
}

TEST_P(ScaleAxisTest, MirroredSolidsHaveMirroredValues) {
  const VoxelGrid grid = bodies(GetParam());
  const std::vector<float> one = values(grid, 2), other = values(bodies(GetParam(), true), 2);
  const int nx = grid.size().x();
  for (std::size_t i = 0; i < one.size(); ++i)
    ASSERT_NEAR(one[i], other[i / nx * nx + nx - 1 - i % nx], 1e-5 * std::max(1.f, one[i]));
}

TEST_P(ScaleAxisTest, ThreadsDoNotChangeABit) {
  const VoxelGrid grid = bodies(GetParam());
  set_thread_count(1);
  const std::vector<float> one = values(grid, 2);
  set_thread_count(4);
  const std::vector<float> four = values(grid, 2);
  set_thread_count(0);
  EXPECT_EQ(one, four);
}

TEST(ScaleAxis, ABallStays) {
  for (const int size : {30, 63, 64, 128, 190}) EXPECT_GT(share_that_stays(ball(size), 2), 0.98) << size;
}

TEST(ScaleAxis, ABoxLosesItsEdgesAndKeepsItsFaces) {
  const int n = 128, low = n - static_cast<int>(0.9 * n) + 1;  // just inside
  const VoxelGrid grid = box(n), round = rounded(grid, 2);
  ASSERT_TRUE(grid(low, low, low));
  EXPECT_FALSE(round(low, low, low));
  EXPECT_FALSE(round(low, low, n / 2));
  for (const Vec3i& face : {Vec3i(low, n / 2, n / 2), Vec3i(n / 2, low, n / 2), Vec3i(n / 2, n / 2, low)})
    EXPECT_TRUE(round(face.x(), face.y(), face.z()));
}

// Its half angle's sine against 1 / 2.
TEST(ScaleAxis, ASlenderConeKeepsItsTipABluntOneDoesNot) {
  const auto height = [](const VoxelGrid& grid) {
    int highest = 0;
    for (int z = 0; z < grid.size().z(); ++z)
      for (int y = 0; y < grid.size().y(); ++y)
        for (int x = 0; x < grid.size().x(); ++x)
          if (grid(x, y, z)) highest = std::max(highest, y);
    return highest;
  };
  EXPECT_GE(height(rounded(cone(15), 2)), height(cone(15)) - 6);
  EXPECT_LE(height(rounded(cone(42), 2)), height(cone(42)) - 8);
}

TEST(ScaleAxis, WhatStandsOnTheGroundKeepsItsRimThere) {
  const VoxelGrid drum =
      solid({100, 80, 100}, [](const Vec3& p) { return std::hypot(p.x(), p.z()) < 40 && p.y() < 30; });
  const VoxelGrid round = rounded(drum, 2);
  EXPECT_TRUE(round(50, 0, 11));
  ASSERT_TRUE(drum(50, 69, 11));
  EXPECT_FALSE(round(50, 69, 11));
}

// Half of the cells of a thin plate would be filled or none.
TEST(ScaleAxis, WhatHasNoBallSaysNothing) {
  const VoxelGrid plate = solid({256, 3, 256}, [](const Vec3& p) { return std::abs(p.y()) < 0.6; });
  for (const float value : values(plate, 2)) ASSERT_EQ(value, 0);
}

}  // namespace
}  // namespace carve
