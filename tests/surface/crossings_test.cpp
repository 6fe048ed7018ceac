#include "carve/surface/crossings.h"

#include <gtest/gtest.h>

#include <cmath>

#include "carve/carving/carve_silhouettes.h"
#include "carve/core/error.h"
#include "carve/core/parallel.h"
#include "carve/mesh/topology.h"
#include "carve/surface/marching_cubes.h"
#include "shapes.h"

namespace carve {
namespace {

struct Surfaces {
  VoxelGrid grid;
  Mesh middles, crossings;
};

Surfaces surfaces(const ViewSet& views, int grid) {
  Surfaces result{carve_silhouettes(views, {.grid = grid}).grid, {}, {}};
  result.middles = marching_cubes(result.grid);
  result.crossings = marching_cubes(result.grid, contour_crossings(views, result.grid));
  return result;
}

/// Random silhouettes at a grid that does not fit their pixels; the seeds that carve to nothing are passed over.
TEST(Crossings, AThousandRandomSilhouetteTriplesGiveSolids) {
  int solids = 0;
  for (unsigned seed = 0; solids < 1000; ++seed) {
    const Vec3i size(6 + static_cast<int>(seed % 9), 6 + static_cast<int>(seed % 7), 6 + static_cast<int>(seed % 5));
    const ViewSet views = views_of_masks(random_masks(size, seed));
    try {
      const Surfaces s = surfaces(views, 8 + static_cast<int>(seed % 11));
      for (const Mesh* mesh : {&s.middles, &s.crossings}) {
        const Topology t = topology(*mesh);
        ASSERT_TRUE(t.solid() && t.unused_vertices == 0 && t.degenerate_triangles == 0 && t.volume > 0) << seed << t;
      }
      ++solids;
    } catch (const NoResult&) {
    }
    ASSERT_LT(seed, 3000u);
  }
}

TEST(Crossings, ABoxsFacesAreExact) {
  for (const Vec3& size : {Vec3(1, 0.75, 0.5), Vec3(0.3, 1, 0.61), Vec3(0.17, 0.45, 1)})
    for (int n : {8, 21, 32, 50}) {
      const ViewSet views = aligned(box(size), kThreeViews, {.pixels = 100});
      const Surfaces s = surfaces(views, n);
      Vec3 low = s.crossings.positions[0], high = low;
      for (const Vec3& p : s.crossings.positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
      EXPECT_LT((low - views.low()).norm() + (high - views.high()).norm(), 1e-6) << n;
      // Marching cubes cuts the edges and corners beyond the outermost centres; all else is exact.
      const Vec3i inside = ((views.size / s.grid.spacing()).array() - 1e-9).ceil().cast<int>();
      Vec3 core, h;
      for (int k = 0; k < 3; ++k) {
        int count = 0;
        for (int i = 0; i < s.grid.size()[k]; ++i) {
          const double c = s.grid.low()[k] + (i + 0.5) * s.grid.spacing();
          count += c > views.low()[k] && c < views.high()[k];
        }
        core[k] = (count - 1) * s.grid.spacing();
        h[k] = (views.size[k] - core[k]) / 2;
      }
      ASSERT_GE(inside.minCoeff(), 1);
      const double expected =
          core.prod() + 2 * (h.x() * core.y() * core.z() + h.y() * core.x() * core.z() + h.z() * core.x() * core.y()) +
          2 * (core.x() * h.y() * h.z() + core.y() * h.x() * h.z() + core.z() * h.x() * h.y()) + 8 * h.prod() / 6;
      EXPECT_NEAR(topology(s.crossings).volume, expected, 1e-6) << n;
    }
}

TEST(Crossings, VolumesAreMuchNearerToTheHulls) {
  for (const Shape& shape : {ball(), torus()})
    for (int n : {24, 50, 100}) {
      const Surfaces s = surfaces(aligned(shape, kThreeViews, {.pixels = 400}), n);
      const double before = std::abs(topology(s.middles).volume - shape.hull_volume);
      const double after = std::abs(topology(s.crossings).volume - shape.hull_volume);
      EXPECT_LT(after, 0.15 * s.grid.spacing() * s.grid.spacing() * 4 + 0.25 * before) << shape.name << " " << n;
    }
}

/// Distance from the surface of the hull of three discs, near it.
double tricylinder(const Vec3& p) {
  const double y = p.y() - 0.5;
  return std::max({std::hypot(p.x(), y), std::hypot(p.z(), y), std::hypot(p.x(), p.z())}) - 0.5;
}

TEST(Crossings, VerticesLieWithinATenthOfAPixelOfTheHull) {
  constexpr int pixels = 300;
  const ViewSet views = aligned(ball(), kViews, {.pixels = pixels});
  for (int n : {32, 75, 150, 300, 500}) {
    const Surfaces s = surfaces(views, n);
    double worst = 0;
    for (const Vec3& p : s.crossings.positions) worst = std::max(worst, std::abs(tricylinder(p)));
    const double clearance = 0.02 * s.grid.spacing();
    EXPECT_LT(worst, 0.1 / pixels + clearance) << n;
  }
}

TEST(Crossings, TellNothingAwayFromOutlines) {
  const ViewSet views = aligned(box(), kThreeViews, {.pixels = 40});
  const VoxelGrid grid = grid_over(views.low(), views.high(), 20);
  const Crossings c = contour_crossings(views, grid);
  const auto count = [](const Raster<float>& raster) {
    return std::ranges::count_if(raster.pixels, [](float value) { return value != 0; });
  };
  EXPECT_EQ(count(c.xy.first), 2 * 15);
  EXPECT_EQ(count(c.xy.second), 2 * 20);
  EXPECT_EQ(count(c.xz.first), 2 * 10);
  EXPECT_EQ(count(c.yz.second), 2 * 15);
  EXPECT_NEAR(c.xy.first(0, 3), -0.5, 1e-6);  // the object is on the upper side of the grid's lower end
  EXPECT_NEAR(c.xy.first(20, 3), 0.5, 1e-6);
}

TEST(Crossings, OppositeViewsSayTheSame) {
  const ViewSet three = aligned(stairs(), kThreeViews, {.pixels = 90});
  constexpr View opposite[] = {View::back, View::left, View::bottom};
  const ViewSet others = aligned(stairs(), opposite, {.pixels = 90}), six = aligned(stairs(), kViews, {.pixels = 90});
  const VoxelGrid grid = carve_silhouettes(three, {.grid = 37}).grid;
  const Mesh mesh = marching_cubes(grid, contour_crossings(three, grid));
  for (const ViewSet* views : {&others, &six}) {
    EXPECT_EQ(carve_silhouettes(*views, {.grid = 37}).grid.words().size(), grid.words().size());
    const Mesh other = marching_cubes(grid, contour_crossings(*views, grid));
    ASSERT_EQ(other.triangles, mesh.triangles);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
      EXPECT_LT((other.positions[i] - mesh.positions[i]).norm(), 1e-6);
  }
}

TEST(Crossings, ThreadsDoNotChangeTheResult) {
  const ViewSet views = aligned(torus(), kViews, {.pixels = 90});
  const VoxelGrid grid = carve_silhouettes(views, {.grid = 100}).grid;
  set_thread_count(1);
  const Mesh one = marching_cubes(grid, contour_crossings(views, grid));
  set_thread_count(2);
  const Mesh two = marching_cubes(grid, contour_crossings(views, grid));
  set_thread_count(0);
  EXPECT_EQ(one, two);
}

}  // namespace
}  // namespace carve
