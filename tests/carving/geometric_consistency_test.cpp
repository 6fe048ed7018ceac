#include "carve/carving/geometric_consistency.h"

#include <gmock/gmock.h>

#include <random>

#include "carve/core/parallel.h"
#include "carve/grid/shadow.h"
#include "carving/box_world.h"
#include "shapes.h"

namespace carve {
namespace {

constexpr Consistency kArms[] = {Consistency::none, Consistency::as_printed, Consistency::two_level,
                                 Consistency::solver};

/// The world sampled at a grid's centres.
VoxelGrid truth(const BoxWorld& world, const VoxelGrid& like) {
  VoxelGrid out(like.size(), like.low(), like.spacing());
  const double unit = 1.0 / world.size.maxCoeff();
  const Vec3 low(-world.size.x() * unit / 2, 0, -world.size.z() * unit / 2);
  for (int z = 0; z < out.size().z(); ++z)
    for (int y = 0; y < out.size().y(); ++y)
      for (int x = 0; x < out.size().x(); ++x) out.set(x, y, z, world.inside((out.centre(x, y, z) - low) / unit));
  return out;
}

double iou(const BoxWorld& world, Consistency arm, int grid, const BoxDrawing& drawing = {}) {
  const ViewSet views = views_of(world, kThreeViews, drawing);
  const Carving hull = carve_silhouettes(views, {.grid = grid});
  return intersection_over_union(apply_consistency(hull, views, {.arm = arm}).grid, truth(world, hull.grid));
}

TEST(Consistency, CouchIsCarvedByOnePassAndByTheSolver) {
  EXPECT_LT(iou(couch(), Consistency::none, 40), 0.85);
  EXPECT_GT(iou(couch(), Consistency::two_level, 40), 0.99);
  EXPECT_GT(iou(couch(), Consistency::solver, 40), 0.99);
}

TEST(Consistency, SolverClimbsWalledStairs) {
  for (const int steps : {3, 5, 8})
    EXPECT_GT(iou(walled_stairs_world(steps), Consistency::solver, 5 * steps + 10), 0.99);
}

TEST(Consistency, BrokenStrokesAreClosed) {
  EXPECT_GT(iou(couch(), Consistency::solver, 40, {.broken = 4}), 0.99);
  EXPECT_GT(iou(walled_stairs_world(5), Consistency::solver, 35, {.broken = 4}), 0.99);
}

class ConsistencyTest : public ::testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, ConsistencyTest, ::testing::Range(0u, 8u));

TEST_P(ConsistencyTest, PocketsThatStrokesDetermineAreFound) {
  EXPECT_GT(iou(random_pockets(GetParam()), Consistency::solver, 36), 0.99);
}

TEST_P(ConsistencyTest, EveryArmKeepsInsideTheHullAndItsSilhouettes) {
  const std::map<View, Mask> masks = random_masks({24, 20, 28}, GetParam());
  ViewSet views = views_of_masks(masks);
  std::mt19937 random(GetParam());
  for (AlignedView& view : views.views)  // scribbles
    for (std::size_t i = 0; i < view.drawing.labels.pixels.size(); ++i)
      if (view.drawing.labels.pixels[i] == Label::surface && random() % 4 == 0)
        view.drawing.labels.pixels[i] = Label::edge;
  const Carving hull = carve_silhouettes(views, {.grid = 28});
  for (const Consistency arm : kArms) {
    const ConsistencyResult result = apply_consistency(hull, views, {.arm = arm});
    EXPECT_TRUE(contains(hull.grid, result.grid));
    EXPECT_GE(result.score.value(), result.hull_score.value());
    for (const View view : kThreeViews) EXPECT_EQ(shadow(result.grid, view), shadow(hull.grid, view));
  }
}

TEST(Consistency, ResultDoesNotDependOnThreads) {
  const ViewSet views = views_of(couch(), kThreeViews);
  const Carving hull = carve_silhouettes(views, {.grid = 40});
  set_thread_count(1);
  const VoxelGrid one = apply_consistency(hull, views).grid;
  set_thread_count(0);
  EXPECT_EQ(apply_consistency(hull, views).grid, one);
}

TEST(Consistency, NodesAreBounded) {
  const ViewSet views = views_of(walled_stairs_world(8), kThreeViews);
  const Carving hull = carve_silhouettes(views, {.grid = 50});
  EXPECT_LE(apply_consistency(hull, views, {.nodes = 100}).nodes, 200);
}

TEST(Consistency, OptionsOutOfRangeAreNamed) {
  const ViewSet views = views_of(couch(), kThreeViews);
  const Carving hull = carve_silhouettes(views, {.grid = 20});
  EXPECT_THAT([&] { apply_consistency(hull, views, {.nodes = -1}); },
              testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr("consistency.nodes must be")));
}

}  // namespace
}  // namespace carve
