#include "carve/surface/marching_cubes.h"

#include <gtest/gtest.h>

#include <random>

#include "carve/carving/carve_silhouettes.h"
#include "carve/core/parallel.h"
#include "shapes.h"
#include "surface/solid_check.h"

namespace carve {
namespace {

VoxelGrid random_grid(const Vec3i& size, unsigned seed, unsigned tenths) {
  std::mt19937 generator(seed);
  VoxelGrid grid(size, Vec3(0.1, -0.2, 0.3), 0.25);
  for (int z = 0; z < size.z(); ++z)
    for (int y = 0; y < size.y(); ++y)
      for (int x = 0; x < size.x(); ++x) grid.set(x, y, z, generator() % 10 < tenths);
  return grid;
}

TEST(MarchingCubes, EveryCellCaseGivesASolid) {
  for (int inside = 1; inside < 256; ++inside) {
    VoxelGrid grid(Vec3i(2, 2, 2), Vec3::Zero(), 1);
    for (int corner = 0; corner < 8; ++corner)
      grid.set(corner & 1, corner >> 1 & 1, corner >> 2, (inside >> corner & 1) != 0);
    const Mesh mesh = marching_cubes(grid);
    ASSERT_EQ(solid_fault(mesh), "") << "case " << inside;
    EXPECT_GT(signed_volume(mesh), 0) << "case " << inside;
  }
}

TEST(MarchingCubes, RandomGridsGiveSolids) {
  for (unsigned seed = 0; seed < 3000; ++seed) {
    const int n = 3 + static_cast<int>(seed % 3);
    const VoxelGrid grid = random_grid({n, n, n}, seed, 1 + seed % 9);
    const Mesh mesh = marching_cubes(grid);
    ASSERT_EQ(solid_fault(mesh), "") << "seed " << seed;
    ASSERT_EQ(mesh.triangles.empty(), grid.count() == 0);
  }
}

TEST(MarchingCubes, RowsOfEveryLengthGiveSolids) {
  for (int nx : {1, 2, 62, 63, 64, 65, 66, 127, 128, 129}) {
    const Mesh mesh = marching_cubes(random_grid({nx, 3, 2}, nx, 5));
    EXPECT_EQ(solid_fault(mesh), "") << nx;
    EXPECT_EQ(solid_fault(marching_cubes(VoxelGrid({nx, 3, 2}, Vec3::Zero(), 1, Fill::full))), "") << nx;
  }
}

TEST(MarchingCubes, OneVoxelIsAnOctahedron) {
  VoxelGrid grid({3, 3, 3}, Vec3::Zero(), 2);
  grid.set(1, 1, 1, true);
  const Mesh mesh = marching_cubes(grid);
  EXPECT_EQ(mesh.positions.size(), 6u);
  EXPECT_EQ(mesh.triangles.size(), 8u);
  EXPECT_NEAR(signed_volume(mesh), 4.0 / 3, 1e-12);  // 4/3 r^3, r = half a voxel
  for (const Vec3& p : mesh.positions) EXPECT_NEAR((p - grid.centre(1, 1, 1)).norm(), 1, 1e-12);
}

}  // namespace
}  // namespace carve
