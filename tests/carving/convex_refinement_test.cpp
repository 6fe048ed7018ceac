#include "carve/carving/convex_refinement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "carve/carving/carve_silhouettes.h"
#include "carve/carving/part_contours.h"
#include "carve/core/parallel.h"
#include "carve/grid/shadow.h"
#include "carve/mesh/topology.h"
#include "carve/surface/marching_cubes.h"
#include "shapes.h"

namespace carve {
namespace {

VoxelGrid refined(const VoxelGrid& solid, const ViewSet& views, const ConvexOptions& options = {}) {
  return refine_convex(solid, views, options).grid;
}

VoxelGrid hull(const ViewSet& views, int grid) { return carve_silhouettes(views, {.grid = grid}).grid; }

/// |x/a|^e + |y/b|^e + |z/c|^e <= 1, standing on y = 0.
Shape superellipsoid(const Vec3& size, double exponent) {
  Shape shape;
  shape.name = "superellipsoid";
  shape.size = size;
  shape.volume = size.prod() * std::pow(std::tgamma(1 + 1 / exponent), 3) / std::tgamma(1 + 3 / exponent);
  shape.spans = [=](View view, double b) {
    const Frame axes = frame(view);
    const double half = size[axes.up.axis] / 2, middle = axes.up.axis == 1 ? half : 0;
    const double rest = 1 - std::pow(std::abs(b - middle) / half, exponent);
    if (rest <= 0) return Spans{};
    const double reach = size[axes.right.axis] / 2 * std::pow(rest, 1 / exponent);
    return Spans{{-reach, reach}};
  };
  return shape;
}

/// Three to six overlapping ellipsoids, boxes between them, as seen by three cameras at the grid's resolution.
ViewSet random_bodies(unsigned seed, bool mirrored_in_x = false) {
  std::mt19937 random(seed);
  const auto between = [&](double a, double b) { return a + (b - a) * (random() % 1000) / 1000; };
  const Vec3i size(48 + static_cast<int>(random() % 24), 40, 56);
  VoxelGrid bodies(size, Vec3::Zero(), 1);
  for (int n = 3 + static_cast<int>(random() % 4); n > 0; --n) {
    Vec3 centre, radii;
    for (int a = 0; a < 3; ++a) centre[a] = between(0.25, 0.75) * size[a], radii[a] = between(0.1, 0.3) * size[a];
    const bool box = random() % 4 == 0;
    for (int z = 0; z < size.z(); ++z)
      for (int y = 0; y < size.y(); ++y)
        for (int x = 0; x < size.x(); ++x) {
          const Vec3 out = (Vec3(x, y, z) - centre).cwiseQuotient(radii);
          if ((box ? out.cwiseAbs().maxCoeff() * 1.4 : out.norm()) <= 1)
            bodies.set(mirrored_in_x ? size.x() - 1 - x : x, y, z, true);
        }
  }
  std::map<View, Mask> masks;
  for (const View view : kThreeViews) masks[view] = shadow(bodies, view);
  return views_of_masks(masks);
}

class ConvexTest : public ::testing::TestWithParam<unsigned> {
 protected:
  ViewSet views_ = random_bodies(GetParam());
  VoxelGrid hull_ = hull(views_, static_cast<int>(std::lround(views_.size.maxCoeff() * 72)));
};
INSTANTIATE_TEST_SUITE_P(Seeds, ConvexTest, ::testing::Range(0u, 24u));

TEST_P(ConvexTest, LiesInsideTheHull) { EXPECT_TRUE(contains(hull_, refined(hull_, views_))); }

TEST_P(ConvexTest, KeepsEveryShadow) {
  const VoxelGrid solid = refined(hull_, views_);
  for (const View view : kViews) EXPECT_EQ(shadow(solid, view), shadow(hull_, view)) << name(view);
}

TEST_P(ConvexTest, OffIsTheIdentity) { EXPECT_EQ(refined(hull_, views_, {.arm = false}), hull_); }

TEST_P(ConvexTest, MirroredDrawingsGiveTheMirroredSolid) {
  const ViewSet mirror = random_bodies(GetParam(), true);
  const VoxelGrid solid = refined(hull_, views_), other = refined(hull(mirror, hull_.size().maxCoeff()), mirror);
  ASSERT_EQ(solid.size(), other.size());
  const Vec3i& n = solid.size();
  for (int z = 0; z < n.z(); ++z)
    for (int y = 0; y < n.y(); ++y)
      for (int x = 0; x < n.x(); ++x) ASSERT_EQ(solid(x, y, z), other(n.x() - 1 - x, y, z));
}

TEST_P(ConvexTest, ThreadsDoNotChangeABit) {
  set_thread_count(1);
  const VoxelGrid one = refined(hull_, views_);
  set_thread_count(4);
  const VoxelGrid four = refined(hull_, views_);
  set_thread_count(0);
  EXPECT_EQ(one, four);
}

TEST_P(ConvexTest, NoiseIsNoFault) {
  const Vec3i size(30, 20, 25);
  const ViewSet views = views_of_masks(random_masks(size, GetParam()));
  const VoxelGrid full = grid_over(views.low(), views.high(), 30, Fill::full);
  EXPECT_TRUE(contains(full, refined(full, views)));
}

TEST_P(ConvexTest, TheScaleAxisOnlyTakesAway) {
  EXPECT_TRUE(contains(refined(hull_, views_, {.scale = 0}), refined(hull_, views_)));
}

TEST(Convex, TheScaleAxisRoundsSolidsThatLookGrownAndNoOthers) {
  int rounded = 0;
  for (unsigned seed = 0; seed < 24; ++seed) {
    const ViewSet views = random_bodies(seed);
    const VoxelGrid solid = hull(views, 72);
    const auto count = [&](double grown, double scale) {
      return refined(solid, views, {.grown = grown, .scale = scale}).count();
    };
    rounded += count(-1, 2) < count(-1, 0);
    EXPECT_EQ(count(1.01, 2), count(1.01, 0)) << seed;
  }
  EXPECT_GE(rounded, 20);
}

TEST(Convex, SomeBodiesAreRounded) {
  int rounded = 0;
  for (unsigned seed = 0; seed < 24; ++seed) {
    const ViewSet views = random_bodies(seed);
    const VoxelGrid solid = hull(views, 72);
    rounded += refined(solid, views).count() < solid.count();
  }
  EXPECT_GE(rounded, 12);
}

TEST(Convex, ThreeCirclesMakeASphere) {
  for (const int grid : {48, 64, 128}) {
    const ViewSet views = aligned(ball(), kThreeViews, {.pixels = 512});
    const VoxelGrid solid = hull(views, grid), sphere = refined(solid, views);
    EXPECT_GT(solid.volume(), 1.1 * ball().volume) << grid;
    EXPECT_NEAR(sphere.volume() / ball().volume, 1, grid >= 128 ? 0.01 : 0.02) << grid;
  }
}

TEST(Convex, AsPrintedThreeCirclesMakeASphereToo) {
  const ViewSet views = aligned(ball(), kThreeViews, {.pixels = 512});
  const VoxelGrid solid = hull(views, 96), sphere = refined(solid, views, {.rule = ConvexRule::as_printed});
  EXPECT_TRUE(contains(solid, sphere));
  EXPECT_NEAR(sphere.volume() / ball().volume, 1, 0.02);
}

TEST(Convex, AsPrintedRectanglesAndStairsChangeNothing) {
  for (const Shape& shape : {box(), stairs()}) {
    const ViewSet views = aligned(shape, kThreeViews);
    EXPECT_EQ(refined(hull(views, 48), views, {.rule = ConvexRule::as_printed}), hull(views, 48)) << shape.name;
  }
}

/// Root mean square distance of a mesh's vertices from a ball's surface.
double roughness(const Mesh& mesh) {
  double squares = 0;
  for (const Vec3& p : mesh.positions) squares += std::pow((p - Vec3(0, 0.5, 0)).norm() - 0.5, 2);
  return std::sqrt(squares / mesh.positions.size());
}

TEST(Convex, TheSpheresMeshIsSmoothAndSolid) {
  for (const int grid : {64, 128}) {
    const ViewSet views = aligned(ball(), kThreeViews, {.pixels = 512});
    const Refinement sphere = refine_convex(hull(views, grid), views);
    Crossings crossings = contour_crossings(views, sphere.grid);
    const Mesh stepped = marching_cubes(sphere.grid, crossings);
    crossings.edges = sphere.crossings;
    const Mesh smooth = marching_cubes(sphere.grid, crossings);
    EXPECT_TRUE(topology(smooth).solid()) << topology(smooth);
    EXPECT_NEAR(topology(smooth).volume / ball().volume, 1, 0.01) << grid;
    EXPECT_LT(roughness(smooth), 0.75 * roughness(stepped)) << grid;
  }
}

TEST(Convex, CrossingsLieOnEdgesThatTheSurfaceCuts) {
  const ViewSet views = random_bodies(3);
  const VoxelGrid solid = hull(views, 72);
  const Refinement result = refine_convex(solid, views);
  const Vec3i& n = solid.size();
  int found = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (int z = axis == 2; z < n.z(); ++z)
      for (int y = axis == 1; y < n.y(); ++y)
        for (int x = axis == 0; x < n.x(); ++x) {
          const float at = result.crossings[axis](x, y, z);
          if (at == 0) continue;
          ++found;
          const Vec3i low = Vec3i(x, y, z) - Vec3i::Unit(axis);
          EXPECT_EQ(result.grid(x, y, z), at < 0);
          EXPECT_EQ(result.grid(low.x(), low.y(), low.z()), at > 0);
          EXPECT_TRUE(solid(x, y, z) && solid(low.x(), low.y(), low.z()));
          EXPECT_LT(std::abs(at), 1);
        }
  EXPECT_GT(found, 100);
}

TEST(Convex, ThreeEllipsesMakeAnEllipsoid) {
  for (const Vec3& size : {Vec3(1, 0.7, 0.5), Vec3(0.4, 1, 0.6), Vec3(0.5, 0.5, 1)}) {
    const Shape shape = superellipsoid(size, 2);
    const ViewSet views = aligned(shape, kThreeViews, {.pixels = 512});
    EXPECT_NEAR(refined(hull(views, 128), views).volume() / shape.volume, 1, 0.015) << size.transpose();
  }
}

TEST(Convex, SquarerOutlinesMakeSquarerSolids) {
  for (const double exponent : {2.0, 2.5, 3.0, 4.0}) {
    const Shape shape = superellipsoid(Vec3(1, 0.8, 0.7), exponent);
    const ViewSet views = aligned(shape, kThreeViews, {.pixels = 512});
    const VoxelGrid solid = hull(views, 64);
    const double before = std::abs(solid.volume() - shape.volume);
    EXPECT_LT(std::abs(refined(solid, views).volume() - shape.volume), before) << exponent;
  }
}

double grown_share(const Shape& shape, int grid) {
  const ViewSet views = aligned(shape, kThreeViews, {.pixels = 512});
  const VoxelGrid solid = hull(views, grid);
  std::array<Sections, 3> cuts;
  std::array<std::vector<Drift>, 3> ways;
  for (int axis = 0; axis < 3; ++axis) {
    cuts[axis] = cut(solid, axis, views);
    ways[axis] = drifts(cuts[axis], grid);
  }
  return grown(cuts, ways);
}

TEST(Convex, RoundThingsLookGrownAndBoxesBuilt) {
  for (const int grid : {48, 96, 128}) {
    EXPECT_GT(grown_share(ball(), grid), 0.5) << grid;
    EXPECT_GT(grown_share(superellipsoid(Vec3(1, 0.7, 0.5), 2), grid), 0.4) << grid;
    for (const Shape& shape : {box(), stairs(5), walled_stairs(3)}) EXPECT_LT(grown_share(shape, grid), -0.5) << grid;
  }
}

TEST_P(ConvexTest, InSolidsThatLookGrownMoreIsRoundedInOthersNothingElse) {
  const VoxelGrid parts = refined(hull_, views_, {.grown = 1.01}), all = refined(hull_, views_, {.grown = -1});
  EXPECT_LE(all.count(), parts.count());
  const VoxelGrid chosen = refined(hull_, views_);
  EXPECT_TRUE(chosen == parts || chosen == all);
}

TEST(Convex, StraightThingsStayAsTheyAre) {
  const Vec3 boxes[] = {{1, 1, 1}, {1, 0.75, 0.5}, {0.2, 1, 0.3}};
  std::vector<Shape> straight{stairs(3), stairs(8), walled_stairs(5)};
  for (const Vec3& size : boxes) straight.push_back(box(size));
  for (const Shape& shape : straight)
    for (const int grid : {32, 100, 128}) {
      const ViewSet views = aligned(shape, kThreeViews, {.pixels = 300});
      const VoxelGrid solid = hull(views, grid);
      EXPECT_EQ(refined(solid, views), solid) << shape.name << " " << grid;
    }
}

TEST(Convex, AStraightTaperStaysAsItIs) {
  Shape pyramid = box({1, 1, 1});
  pyramid.spans = [](View view, double b) {
    const double half = view == View::top ? 0.5 : 0.5 - 0.3 * b;
    return Spans{{-half, half}};
  };
  const ViewSet views = aligned(pyramid, kThreeViews, {.pixels = 512});
  const VoxelGrid solid = hull(views, 128);
  EXPECT_EQ(refined(solid, views), solid);
}

/// A cylinder of height 1 - tip below a cone: front and side show straight lines only, the top a circle.
Shape turned(double tip) {
  Shape shape;
  shape.name = "cylinder and cone";
  shape.size = Vec3(0.6, 1, 0.6);
  shape.volume = std::numbers::pi * 0.09 * (1 - tip + tip / 3);
  shape.spans = [=](View view, double b) {
    const double half = view == View::top ? std::sqrt(std::max(0.0, 0.09 - b * b)) : 0.3 * std::min(1.0, (1 - b) / tip);
    return half > 0 ? Spans{{-half, half}} : Spans{};
  };
  return shape;
}

TEST(Convex, ATaperFromACircleIsACone) {
  for (const double tip : {0.35, 0.5, 0.6, 0.8})
    for (const int grid : {64, 128}) {
      const ViewSet views = aligned(turned(tip), kThreeViews, {.pixels = 512});
      const VoxelGrid solid = hull(views, grid);
      const double before = solid.volume() / turned(tip).volume - 1;
      EXPECT_LT(std::abs(refined(solid, views).volume() / turned(tip).volume - 1), 0.25 * before) << tip << " " << grid;
    }
}

TEST(Convex, RefusesOptionsOutOfRange) {
  const ViewSet views = aligned(box());
  EXPECT_THROW(refined(hull(views, 16), views, {.evidence = 2}), std::invalid_argument);
}

}  // namespace
}  // namespace carve
