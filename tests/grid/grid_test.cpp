#include <gmock/gmock.h>

#include <random>

#include "carve/core/parallel.h"
#include "carve/grid/shadow.h"
#include "carve/grid/voxel_grid.h"

namespace carve {
namespace {

VoxelGrid random_grid(const Vec3i& size, unsigned seed) {
  std::mt19937 generator(seed);
  VoxelGrid grid(size, Vec3(-1, 0, 2), 0.5);
  for (int z = 0; z < size.z(); ++z)
    for (int y = 0; y < size.y(); ++y)
      for (int x = 0; x < size.x(); ++x) grid.set(x, y, z, generator() % 7 == 0);
  return grid;
}

TEST(VoxelGrid, SizesOutOfRangeAreRefused) {
  for (const Vec3i& size : {Vec3i(0, 1, 1), Vec3i(1, kLargestGrid + 1, 1), Vec3i(1, 1, -5), Vec3i(1, 2000000000, 1)})
    EXPECT_THROW(VoxelGrid(size, Vec3::Zero(), 1), std::invalid_argument);
  EXPECT_THROW(VoxelGrid({1, 1, 1}, Vec3::Zero(), 0), std::invalid_argument);
  EXPECT_THROW(VoxelGrid({1, 1, 1}, Vec3::Zero(), std::nan("")), std::invalid_argument);
  EXPECT_THROW(grid_over(Vec3::Zero(), Vec3::Ones(), 0), std::invalid_argument);
  EXPECT_THROW(grid_over(Vec3::Zero(), Vec3::Ones(), kLargestGrid + 1), std::invalid_argument);
  EXPECT_THROW(grid_over(Vec3::Zero(), Vec3(1, 0, 1), 8), std::invalid_argument);
  try {
    VoxelGrid({4, 4, 2049}, Vec3::Zero(), 1);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "grid size must be in [1, 2048], got 2049");
  }
}

TEST(VoxelGrid, BitsPastTheRowStayZero) {
  for (int nx : {1, 63, 64, 65, 128, 200}) {
    const VoxelGrid full({nx, 3, 2}, Vec3::Zero(), 1, Fill::full);
    EXPECT_EQ(full.count(), nx * 6);
    EXPECT_EQ(VoxelGrid({nx, 3, 2}, Vec3::Zero(), 1).count(), 0);
    VoxelGrid set({nx, 3, 2}, Vec3::Zero(), 1);
    for (int z = 0; z < 2; ++z)
      for (int y = 0; y < 3; ++y)
        for (int x = 0; x < nx; ++x) set.set(x, y, z, true);
    EXPECT_EQ(set, full);
  }
}

TEST(VoxelGrid, CoversTheBoxSymmetrically) {
  const Vec3 low(-0.5, 0, -0.2), high(0.5, 0.73, 0.2);
  for (int resolution : {1, 7, 8, 10, 100}) {
    const VoxelGrid grid = grid_over(low, high, resolution);
    const Vec3 end = grid.low() + grid.spacing() * grid.size().cast<double>();
    EXPECT_EQ(grid.size().x(), resolution);
    EXPECT_TRUE(((grid.low() - low).array() < 1e-9).all() && ((end - high).array() > -1e-9).all());
    EXPECT_TRUE(((low - grid.low()).array() < grid.spacing()).all());
    EXPECT_LT((grid.low() + end - low - high).norm(), 1e-9);
  }
  EXPECT_EQ(grid_over(low, high, 10).size(), Vec3i(10, 8, 4));  // 0.4 / 0.1 is four voxels, not five
}

TEST(VoxelGrid, IntersectionOverUnionAndContainment) {
  const VoxelGrid a = random_grid({70, 5, 4}, 1), b = random_grid({70, 5, 4}, 2), none({70, 5, 4}, Vec3::Zero(), 1);
  VoxelGrid both = a;
  for (std::size_t i = 0; i < both.words().size(); ++i) both.words()[i] &= b.words()[i];
  EXPECT_TRUE(contains(a, both) && contains(b, both) && contains(a, none));
  EXPECT_FALSE(contains(both, a));
  EXPECT_DOUBLE_EQ(intersection_over_union(a, b),
                   static_cast<double>(both.count()) / (a.count() + b.count() - both.count()));
  EXPECT_EQ(intersection_over_union(none, none), 1);
  EXPECT_THROW(contains(a, VoxelGrid({5, 70, 4}, Vec3::Zero(), 1)), std::invalid_argument);
}

TEST(VoxelGrid, LargeGridsReuseMemoryWithoutKeepingContents) {
  for (int i = 0; i < 3; ++i) {
    VoxelGrid grid({512, 256, 128}, Vec3::Zero(), 1);
    EXPECT_EQ(grid.count(), 0);
    grid.set(100, 100, 100, true);
    const VoxelGrid copy = grid;
    EXPECT_EQ(copy, grid);
    EXPECT_EQ(copy.count(), 1);
  }
}

TEST(Shadow, OneLitVoxelLandsOnTheExpectedPixelOfAllSixViews) {
  // Sizes 5, 4, 3 along x, y, z; the voxel is (1, 3, 0): left of the middle, on top, at the back.
  VoxelGrid grid({5, 4, 3}, Vec3::Zero(), 1);
  grid.set(1, 3, 0, true);
  struct Expected {
    View view;
    int width, height, column, row, depth;
  };
  for (const Expected& e : {Expected{View::front, 5, 4, 1, 0, 2},
                            {View::side, 3, 4, 2, 0, 3},
                            {View::top, 5, 3, 1, 0, 0},
                            {View::back, 5, 4, 3, 0, 0},
                            {View::left, 3, 4, 0, 0, 1},
                            {View::bottom, 5, 3, 1, 2, 3}}) {
    const Mask mask = shadow(grid, e.view);
    const Raster<int> depths = depth(grid, e.view);
    EXPECT_EQ(mask.width, e.width) << name(e.view);
    EXPECT_EQ(mask.height, e.height) << name(e.view);
    for (int j = 0; j < mask.height; ++j)
      for (int i = 0; i < mask.width; ++i) {
        const bool lit = i == e.column && j == e.row;
        EXPECT_EQ(mask(i, j), lit) << name(e.view) << " " << i << " " << j;
        EXPECT_EQ(depths(i, j), lit ? e.depth : -1) << name(e.view);
      }
  }
}

TEST(Shadow, DepthIsTheFirstVoxelFromTheViewer) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const VoxelGrid grid = random_grid({67 + static_cast<int>(seed), 9, 7}, seed);
    for (View view : kViews) {
      const ShadowLayout layout(grid.size(), view);
      const Raster<int> depths = depth(grid, view);
      const Mask mask = shadow(grid, view);
      for (int j = 0; j < layout.height; ++j)
        for (int i = 0; i < layout.width; ++i) {
          Vec3i voxel;
          voxel[layout.frame.right.axis] = layout.right_index(i);
          voxel[layout.frame.up.axis] = layout.up_index(j);
          int expected = -1;
          for (int d = 0; d < layout.depth && expected < 0; ++d) {
            voxel[layout.frame.toward.axis] = layout.frame.toward.sign > 0 ? layout.depth - 1 - d : d;
            if (grid(voxel.x(), voxel.y(), voxel.z())) expected = d;
          }
          ASSERT_EQ(depths(i, j), expected) << name(view);
          ASSERT_EQ(mask(i, j), expected >= 0) << name(view);
        }
    }
  }
}

TEST(Shadow, OppositeViewsAreMirrored) {
  const VoxelGrid grid = random_grid({66, 8, 5}, 3);
  const auto turned = [](Mask mask, bool rows) {
    Mask result = mask;
    for (int y = 0; y < mask.height; ++y)
      for (int x = 0; x < mask.width; ++x)
        result(x, y) = rows ? mask(x, mask.height - 1 - y) : mask(mask.width - 1 - x, y);
    return result;
  };
  EXPECT_EQ(shadow(grid, View::back), turned(shadow(grid, View::front), false));
  EXPECT_EQ(shadow(grid, View::left), turned(shadow(grid, View::side), false));
  EXPECT_EQ(shadow(grid, View::bottom), turned(shadow(grid, View::top), true));
}

}  // namespace
}  // namespace carve
