#include "carve/surface/sharpen.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "carve/carving/carve_silhouettes.h"
#include "carve/core/error.h"
#include "carve/core/parallel.h"
#include "carve/mesh/self_intersections.h"
#include "carve/mesh/topology.h"
#include "carve/surface/contour_normals.h"
#include "carve/surface/marching_cubes.h"
#include "shapes.h"

namespace carve {
namespace {

struct Surfaces {
  VoxelGrid grid;
  Mesh chamfered, sharp;
  Guides guides;
};

Surfaces surfaces(VoxelGrid grid, const Crossings& crossings) {
  Surfaces s{std::move(grid), {}, {}, {}};
  s.chamfered = marching_cubes(s.grid, crossings);
  s.guides = vertex_guides(s.chamfered, s.grid, crossings);
  s.sharp = sharpen(s.chamfered, s.grid, s.guides);
  return s;
}

Surfaces surfaces(const ViewSet& views, int grid) {
  VoxelGrid hull = carve_silhouettes(views, {.grid = grid}).grid;
  const Crossings crossings = contour_crossings(views, hull);
  return surfaces(std::move(hull), crossings);
}

void expect_solid(const Mesh& mesh, unsigned seed) {
  const Topology t = topology(mesh);
  ASSERT_TRUE(t.solid() && t.unused_vertices == 0 && t.degenerate_triangles == 0) << seed << "\n" << t;
}

TEST(Sharpen, ABoxIsExact) {
  for (const Vec3& size : {Vec3(1, 0.75, 0.5), Vec3(0.3, 1, 0.61), Vec3(0.17, 0.45, 1)})
    for (const int n : {12, 21, 32, 50}) {
      const Surfaces s = surfaces(aligned(box(size), kThreeViews, {.pixels = 100}), n);
      expect_solid(s.sharp, n);
      // Crossings keep 0.02 voxels away from the centres, and so do the corners.
      const double close = 0.021 * s.grid.spacing();
      EXPECT_NEAR(topology(s.sharp).volume, size.prod(), 2 * close * (size.x() + size.y() + size.z())) << n;
      EXPECT_LT(topology(s.chamfered).volume, topology(s.sharp).volume);
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3 exact((corner & 1 ? 0.5 : -0.5) * size.x(), (corner & 2) ? size.y() : 0,
                         ((corner & 4) ? 0.5 : -0.5) * size.z());
        double nearest = 1;
        for (const Vec3& p : s.sharp.positions) nearest = std::min(nearest, (p - exact).norm());
        EXPECT_LT(nearest, 2 * close) << n;
      }
    }
}

TEST(Sharpen, StairsHaveTheirEdges) {
  for (const int steps : {3, 5, 8})
    for (const int n : {64, 100, 128}) {
      const Shape shape = stairs(steps);
      const Surfaces s = surfaces(aligned(shape, kThreeViews, {.pixels = 400}), n);
      expect_solid(s.sharp, n);
      const double close = 0.03 * s.grid.spacing();
      EXPECT_NEAR(topology(s.sharp).volume, shape.volume, 8 * close) << n;
      int edges = 0;
      for (const Guide& guide : s.guides) edges += guide.kind == Guide::Kind::line;
      EXPECT_GT(edges, 2 * steps * n / 2) << n;
    }
}

TEST(Sharpen, RandomSilhouettesGiveSolidsWithoutNewIntersections) {
  int solids = 0, sharpened = 0;
  for (unsigned seed = 0; solids < 300; ++seed) {
    const Vec3i size(6 + static_cast<int>(seed % 9), 6 + static_cast<int>(seed % 7), 6 + static_cast<int>(seed % 5));
    const ViewSet views = views_of_masks(random_masks(size, seed));
    ASSERT_LT(seed, 1000u);
    try {
      const Surfaces s = surfaces(views, 8 + static_cast<int>(seed % 11));
      expect_solid(s.sharp, seed);
      ASSERT_EQ(s.guides.size(), s.sharp.positions.size());
      EXPECT_LE(self_intersections(s.sharp).size(), self_intersections(s.chamfered).size()) << seed;
      sharpened += s.sharp.positions.size() > s.chamfered.positions.size();
      ++solids;
    } catch (const NoResult&) {
    }
  }
  EXPECT_GT(sharpened, 100);
}

/// Grids and normals that no drawing would give: every voxel and every normal random.
TEST(Sharpen, AdversarialGridsGiveSolidsWithoutNewIntersections) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    std::mt19937 random(seed);
    const int n = 3 + static_cast<int>(seed % 4);
    VoxelGrid grid({n, n, n}, Vec3(0.1, -0.2, 0.3), 0.25);
    for (int z = 0; z < n; ++z)
      for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) grid.set(x, y, z, random() % 10 <= seed % 9);
    if (grid.count() == 0) continue;
    const Mesh mesh = marching_cubes(grid);
    Guides guides(mesh.positions.size());
    for (Guide& guide : guides) {
      const auto value = [&] { return static_cast<float>(random() % 1000) / 500 - 0.999f; };
      guide = {Guide::Kind::plane, Eigen::Vector3f(value(), value(), value()).normalized()};
    }
    const Mesh sharp = sharpen(mesh, grid, guides);
    expect_solid(sharp, seed);
    EXPECT_LE(self_intersections(sharp).size(), self_intersections(mesh).size()) << seed;
  }
}

TEST(Sharpen, RoundThingsStayAsTheyAre) {
  // A lying torus' outline in the top view, far from where sections meet.
  const ViewSet views = aligned(torus(), kThreeViews, {.pixels = 400});
  const Surfaces s = surfaces(views, 64);
  expect_solid(s.sharp, 0);
  EXPECT_LT(s.sharp.positions.size(), 1.15 * s.chamfered.positions.size());
}

TEST(Sharpen, AnEmptyMeshStaysEmpty) {
  Guides guides;
  EXPECT_TRUE(sharpen({}, VoxelGrid({4, 4, 4}, Vec3::Zero(), 1), guides).triangles.empty());
}

TEST(Sharpen, ThreadsDoNotChangeTheResult) {
  const ViewSet views = aligned(walled_stairs(), kThreeViews, {.pixels = 90});
  set_thread_count(1);
  const Mesh one = surfaces(views, 60).sharp;
  set_thread_count(2);
  const Mesh two = surfaces(views, 60).sharp;
  set_thread_count(0);
  EXPECT_EQ(one, two);
}

TEST(ContourNormals, ACirclesNormalsAreRadial) {
  for (const int n : {32, 100, 200}) {
    const ViewSet views = aligned(ball(), kThreeViews, {.pixels = 400});
    const VoxelGrid grid = grid_over(views.low(), views.high(), n);
    const PlaneCrossings plane = contour_crossings(views, grid).xy;
    const PlaneNormals normals = contour_normals(plane);
    int found = 0;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i <= n; ++i) {
        const float at = plane.first(i, j);
        if (at == 0) continue;
        const Vec2 p((i - 0.5 + (at > 0 ? at : 1 + at)) / n - 0.5, (j + 0.5) / n - 0.5);
        const Vec2 normal(normals.first(i, j)[0], normals.first(i, j)[1]);
        if (normal.isZero()) continue;
        ++found;
        EXPECT_GT(normal.dot(p.normalized()), std::cos(8 * 3.14159265 / 180)) << n << " " << i << " " << j;
      }
    EXPECT_GE(found, 2 * n - 8);
  }
}

TEST(ContourNormals, ASquaresNormalsAreExactUpToItsCorners) {
  const ViewSet views = aligned(box({1, 0.83, 0.7}), kThreeViews, {.pixels = 200});
  const VoxelGrid grid = grid_over(views.low(), views.high(), 47);
  const PlaneCrossings plane = contour_crossings(views, grid).xy;
  const PlaneNormals normals = contour_normals(plane);
  for (int j = 0; j < plane.first.height; ++j)
    for (int i = 0; i < plane.first.width; ++i)
      if (plane.first(i, j) != 0) {
        EXPECT_NEAR(std::abs(normals.first(i, j)[0]), 1, 1e-5) << i << " " << j;
      }
}

}  // namespace
}  // namespace carve
