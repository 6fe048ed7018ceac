#include "carve/carving/stroke_crossings.h"

#include <gmock/gmock.h>

#include "carve/carving/geometric_consistency.h"
#include "carve/mesh/topology.h"
#include "carve/surface/crossings.h"
#include "carve/surface/marching_cubes.h"
#include "carving/box_world.h"
#include "shapes.h"

namespace carve {
namespace {

constexpr BoxDrawing kDrawing{.stroke = 4};  // an even width has its middle between two pixels, on the depth jump

/// Calls use(axis, upper) for each edge between a voxel that was kept and one of the hull that was not.
template <class Use>
void each_cut(const VoxelGrid& hull, const VoxelGrid& kept, Use&& use) {
  const Vec3i& n = hull.size();
  for (int axis = 0; axis < 3; ++axis)
    for (int z = axis == 2; z < n.z(); ++z)
      for (int y = axis == 1; y < n.y(); ++y)
        for (int x = axis == 0; x < n.x(); ++x) {
          const Vec3i low = Vec3i(x, y, z) - Vec3i::Unit(axis);
          if (hull(x, y, z) && hull(low.x(), low.y(), low.z()) && kept(x, y, z) != kept(low.x(), low.y(), low.z()))
            use(axis, Vec3i(x, y, z));
        }
}

class StrokeCrossingsTest : public ::testing::TestWithParam<unsigned> {};

TEST_P(StrokeCrossingsTest, LieWhereTheBoxesEndAndNowhereElse) {
  const BoxWorld world = random_pockets(GetParam());
  const ViewSet views = views_of(world, kThreeViews, kDrawing);
  const Carving hull = carve_silhouettes(views, {.grid = 41});
  const ConsistencyResult carved = apply_consistency(hull, views);
  const double unit = 1.0 / world.size.maxCoeff(), voxel = hull.grid.spacing();
  std::size_t cut = 0, found = 0;
  each_cut(hull.grid, carved.grid, [&](int axis, const Vec3i& upper) {
    ++cut;
    const float at = carved.crossings[axis](upper.x(), upper.y(), upper.z());
    if (at == 0) return;
    ++found;
    ASSERT_EQ(carved.grid(upper.x(), upper.y(), upper.z()), at < 0);
    const double index = upper[axis] + (at > 0 ? at - 0.5 : at + 0.5);
    const double place = (hull.grid.low()[axis] + index * voxel - views.low()[axis]) / unit;
    EXPECT_LT(std::abs(place - std::round(place)) * unit, 0.1 * voxel) << axis << " " << upper.transpose();
  });
  EXPECT_GT(cut, 1000);
  EXPECT_GE(found, 0.95 * cut);
  std::size_t all = 0;
  for (const EdgeCrossings& edges : carved.crossings) all += edges.entries.size();
  EXPECT_EQ(all, found);
}

INSTANTIATE_TEST_SUITE_P(Seeds, StrokeCrossingsTest, ::testing::Range(0u, 8u));

TEST(StrokeCrossings, MakeTheVolumeRightOnEveryGrid) {
  for (const BoxWorld& world : {couch(), walled_stairs_world(5)}) {
    const ViewSet views = views_of(world, kThreeViews, kDrawing);
    double truth = 0;
    for (int z = 0; z < world.size.z(); ++z)
      for (int y = 0; y < world.size.y(); ++y)
        for (int x = 0; x < world.size.x(); ++x) truth += world.inside(Vec3(x + 0.5, y + 0.5, z + 0.5));
    truth /= std::pow(world.size.maxCoeff(), 3);
    for (const int grid : {37, 50, 61, 83}) {
      const Carving hull = carve_silhouettes(views, {.grid = grid});
      ConsistencyResult carved = apply_consistency(hull, views);
      Crossings crossings = contour_crossings(views, carved.grid);
      crossings.strokes = std::move(carved.crossings);
      const Topology solid = topology(marching_cubes(carved.grid, crossings));
      EXPECT_TRUE(solid.solid()) << solid;
      EXPECT_NEAR(solid.volume / truth, 1, 0.005) << grid;
    }
  }
}

TEST(StrokeCrossings, AreWhereAColourChangesWithoutAStroke) {
  // A box of two colours, the border 3/8 of a voxel beyond a voxel's face.
  Drawing drawing = draw({.size = {32, 32, 32}, .parts = {{{0, 0, 0}, {32, 32, 32}}}}, View::front, kDrawing);
  const int border = drawing.bounds.x0 + 75;  // of 192 pixels
  for (int y = drawing.bounds.y0; y < drawing.bounds.y1; ++y)
    for (int x = border; x < drawing.bounds.x1; ++x)
      if (drawing.labels(x, y) == Label::surface) drawing.picture(x, y) = {220, 160, 90, 255};
  const Drawing side = draw({.size = {32, 32, 32}, .parts = {{{0, 0, 0}, {32, 32, 32}}}}, View::side, kDrawing);
  const ViewSet views = align({{View::front, drawing}, {View::side, side}});
  const VoxelGrid hull = carve_silhouettes(views, {.grid = 24}).grid;  // 8 pixels a voxel
  const CutDrawing cut(*views.find(View::front), 1);
  const RegionMap map = cut.on(hull);
  const RegionBorders borders = cut.borders(map, hull);
  int found = 0;
  for (int j = 0; j < 24; ++j)
    for (int i = 0; i < 24; ++i) {
      EXPECT_EQ(borders.below(i, j), 0);
      if (borders.right(i, j) == 0) continue;
      ++found;
      EXPECT_EQ(i, 8);  // centres at 68 and 76
      EXPECT_NEAR(borders.right(i, j), 7.0 / 8, 1e-4);
    }
  EXPECT_GE(found, 22);
}

}  // namespace
}  // namespace carve
