#include "carve/surface/marching_cubes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "carve/core/parallel.h"
#include "carve/mesh/topology.h"
#include "carve/surface/cube_table.h"
#include "shapes.h"

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

/// Random crossings on every grid line, many of them nothing.
Crossings random_crossings(const Vec3i& size, unsigned seed) {
  std::mt19937 generator(seed);
  const auto plane = [&](int first, int second) {
    PlaneCrossings plane{Raster<float>(first + 1, second), Raster<float>(first, second + 1)};
    for (Raster<float>* raster : {&plane.first, &plane.second})
      for (float& value : raster->pixels) {
        const float distance = 0.02f + 0.96f * static_cast<float>(generator() % 1000) / 1000.f;
        value = generator() % 3 == 0 ? 0 : generator() % 2 ? distance : -distance;
      }
    return plane;
  };
  return {plane(size.x(), size.y()), plane(size.x(), size.z()), plane(size.y(), size.z())};
}

void expect_solid(const Mesh& mesh, const std::string& what) {
  const Topology t = topology(mesh);
  ASSERT_TRUE(t.solid()) << what << "\n" << t;
  ASSERT_EQ(t.unused_vertices, 0) << what;
  ASSERT_EQ(t.degenerate_triangles, 0) << what;
  ASSERT_GT(t.volume, 0) << what;
}

TEST(CubeTable, NoInnerEdgeLiesOnAFace) {
  const auto share_a_face = [](int a, int b) {
    const auto [p, q] = cube_edge(a);
    const auto [r, s] = cube_edge(b);
    return (p & q & r & s) != 0 || (p | q | r | s) != 7;
  };
  for (const CubeCase& cube : cube_table()) {
    int uses[12][12] = {};
    for (int t = 0; t < cube.triangles; ++t)
      for (int k = 0; k < 3; ++k) ++uses[cube.edges[t][k]][cube.edges[t][(k + 1) % 3]];
    for (int a = 0; a < 12; ++a)
      for (int b = 0; b < 12; ++b) {
        ASSERT_LE(uses[a][b], 1);
        if (!uses[a][b]) continue;
        EXPECT_EQ(share_a_face(a, b), uses[b][a] == 0) << "an inner edge on a face, or a side that is on none";
      }
  }
}

TEST(CubeTable, VerticesLieOnTheEdgesThatAreCut) {
  for (int inside = 0; inside < 256; ++inside) {
    bool used[12] = {};
    const CubeCase& cube = cube_table()[inside];
    for (int t = 0; t < cube.triangles; ++t)
      for (int edge : cube.edges[t]) used[edge] = true;
    for (int edge = 0; edge < 12; ++edge) {
      const auto [a, b] = cube_edge(edge);
      EXPECT_EQ(used[edge], ((inside >> a ^ inside >> b) & 1) != 0) << inside;
    }
  }
}

TEST(MarchingCubes, EveryCellCaseGivesASolid) {
  for (int inside = 1; inside < 256; ++inside) {
    VoxelGrid grid({2, 2, 2}, Vec3::Zero(), 1);
    for (int corner = 0; corner < 8; ++corner)
      grid.set(corner & 1, corner >> 1 & 1, corner >> 2, (inside >> corner & 1) != 0);
    expect_solid(marching_cubes(grid), "case " + std::to_string(inside));
  }
}

TEST(MarchingCubes, EveryPairOfNeighbouringCellsGivesASolid) {
  for (int inside = 1; inside < 4096; ++inside) {
    VoxelGrid grid({3, 2, 2}, Vec3::Zero(), 1);
    for (int k = 0; k < 12; ++k) grid.set(k % 3, k / 3 % 2, k / 6, (inside >> k & 1) != 0);
    expect_solid(marching_cubes(grid), "voxels " + std::to_string(inside));
  }
}

TEST(MarchingCubes, RandomGridsWithRandomCrossingsGiveSolids) {
  for (unsigned seed = 0; seed < 4000; ++seed) {
    const int n = 3 + static_cast<int>(seed % 3);
    const VoxelGrid grid = random_grid({n, n, n}, seed, 1 + seed % 9);
    if (grid.count() > 0) expect_solid(marching_cubes(grid, random_crossings(grid.size(), seed)), std::to_string(seed));
  }
}

TEST(MarchingCubes, RowsOfEveryLengthGiveSolids) {
  for (int nx : {1, 2, 62, 63, 64, 65, 66, 127, 128, 129, 191, 192, 193}) {
    const VoxelGrid grid = random_grid({nx, 3, 2}, static_cast<unsigned>(nx), 5);
    expect_solid(marching_cubes(grid, random_crossings(grid.size(), 1)), std::to_string(nx));
    expect_solid(marching_cubes(VoxelGrid({nx, 3, 2}, Vec3::Zero(), 1, Fill::full)), std::to_string(nx));
  }
}

TEST(MarchingCubes, AnEmptyGridHasNoSurface) {
  const Mesh mesh = marching_cubes(VoxelGrid({70, 4, 4}, Vec3::Zero(), 1));
  EXPECT_TRUE(mesh.positions.empty() && mesh.triangles.empty());
}

TEST(MarchingCubes, CrossingsOfAnotherGridAreRefused) {
  const VoxelGrid grid({8, 9, 10}, Vec3::Zero(), 1);
  EXPECT_NO_THROW(marching_cubes(grid, random_crossings({8, 9, 10}, 1)));
  for (const Vec3i& size : {Vec3i(9, 9, 10), Vec3i(8, 8, 10), Vec3i(8, 9, 11)})
    EXPECT_THROW(marching_cubes(grid, random_crossings(size, 1)), std::invalid_argument);
}

TEST(MarchingCubes, OneVoxelIsAnOctahedron) {
  VoxelGrid grid({3, 3, 3}, Vec3::Zero(), 2);
  grid.set(1, 1, 1, true);
  const Mesh mesh = marching_cubes(grid);
  EXPECT_EQ(mesh.positions.size(), 6u);
  EXPECT_EQ(mesh.triangles.size(), 8u);
  EXPECT_NEAR(topology(mesh).volume, 4.0 / 3, 1e-12);  // 4/3 r^3, r = half a voxel
  for (const Vec3& p : mesh.positions) EXPECT_NEAR((p - grid.centre(1, 1, 1)).norm(), 1, 1e-12);
}

TEST(MarchingCubes, TouchingVoxels) {
  // Voxels that share an edge or a corner stay apart; voxels that share a face are one.
  for (const auto& [second, components] : {std::pair(Vec3i(2, 2, 1), 2), {Vec3i(2, 2, 2), 2}, {Vec3i(2, 1, 1), 1}}) {
    VoxelGrid grid({4, 4, 4}, Vec3::Zero(), 1);
    grid.set(1, 1, 1, true);
    grid.set(second.x(), second.y(), second.z(), true);
    EXPECT_EQ(topology(marching_cubes(grid)).components, components);
  }
}

/// Voxel components by faces, and background components by everything: what the ambiguous faces' rule makes of them.
TEST(MarchingCubes, HolesAndHandlesAreCounted) {
  VoxelGrid ring({5, 5, 3}, Vec3::Zero(), 1);
  for (int y = 1; y < 4; ++y)
    for (int x = 1; x < 4; ++x) ring.set(x, y, 1, x != 2 || y != 2);
  EXPECT_EQ(topology(marching_cubes(ring)).genus, 1);
  VoxelGrid shell({5, 5, 5}, Vec3::Zero(), 1, Fill::full);
  shell.set(2, 2, 2, false);
  const Topology t = topology(marching_cubes(shell));
  EXPECT_EQ(t.components, 2);
  EXPECT_EQ(t.euler, 4);
}

TEST(MarchingCubes, VerticesLieOnGridLinesBetweenInsideAndOutside) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const VoxelGrid grid = random_grid({9, 7, 8}, seed, 4);
    const Mesh mesh = marching_cubes(grid, random_crossings(grid.size(), seed));
    for (const Vec3& position : mesh.positions) {
      const Vec3 p = ((position - grid.low()) / grid.spacing()).array() - 0.5;  // in centres
      int along = -1;
      Vec3i low;
      for (int k = 0; k < 3; ++k) {
        low[k] = static_cast<int>(std::floor(p[k] + 1e-9));
        if (p[k] - low[k] < 0.01) continue;
        ASSERT_EQ(along, -1);
        along = k;
      }
      ASSERT_GE(along, 0);
      const double share = p[along] - low[along];
      EXPECT_TRUE(share > 0.0199 && share < 0.9801) << share;
      Vec3i high = low;
      ++high[along];
      const auto inside = [&](const Vec3i& v) {
        return grid.contains(v.x(), v.y(), v.z()) && grid(v.x(), v.y(), v.z());
      };
      EXPECT_NE(inside(low), inside(high));
    }
  }
}

TEST(MarchingCubes, OrderIsTheScansWhateverTheThreads) {
  const VoxelGrid grid = random_grid({130, 40, 50}, 5, 4);
  const Crossings crossings = random_crossings(grid.size(), 6);
  set_thread_count(1);
  const Mesh one = marching_cubes(grid, crossings);
  set_thread_count(2);
  const Mesh two = marching_cubes(grid, crossings);
  set_thread_count(0);
  EXPECT_EQ(one, two);
  int most = -1;  // a vertex is first named within a row of cells, and its own row of edges, of its index
  for (const Triangle& t : one.triangles) most = std::max({most, t[0], t[1], t[2]});
  EXPECT_EQ(most + 1, static_cast<int>(one.positions.size()));
}

TEST(MarchingCubes, MiddlesCutABoxsEdgesAndCornersByHalfAVoxel) {
  for (const Vec3i& n : {Vec3i(1, 1, 1), Vec3i(4, 7, 3), Vec3i(70, 5, 9)}) {
    const Vec3 core = (n.array() - 1).cast<double>();  // between the outermost centres
    const double h = 0.5;
    const double expected = core.prod() + 2 * h * (core.x() * core.y() + core.y() * core.z() + core.z() * core.x()) +
                            4 * core.sum() * h * h / 2 + 8 * h * h * h / 6;
    EXPECT_NEAR(topology(marching_cubes(VoxelGrid(n, Vec3::Zero(), 1, Fill::full))).volume, expected, 1e-9);
  }
}

TEST(MarchingCubes, MiddlesKeepAtLeastASixthOfEveryVoxelOnEitherSide) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const VoxelGrid grid = random_grid({6, 5, 7}, seed, 1 + seed % 9);
    const double voxel = std::pow(grid.spacing(), 3), inside = static_cast<double>(grid.count()), all = 6 * 5 * 7;
    if (inside == 0) continue;
    const double volume = topology(marching_cubes(grid)).volume / voxel;
    EXPECT_GE(volume, inside / 6 - 1e-9) << seed;
    // An empty voxel within the grid keeps at least its own octahedron; the surface reaches half a voxel out of
    // centres.
    EXPECT_LE(volume, all - (all - inside) / 6 + 1e-9) << seed;
  }
}

}  // namespace
}  // namespace carve
