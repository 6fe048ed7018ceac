#include "carve/photo/space_carving.h"

#include <gmock/gmock.h>

#include "carve/core/parallel.h"
#include "carve/photo/silhouette_hull.h"
#include "photo/ball_photos.h"

namespace carve {
namespace {

const BallScene kStriped{.colour = striped};
const RigOptions kFew{.views = 5, .elevations = {"15", "-35"}, .size = 320};

VoxelGrid region(const BallScene& scene, int grid) {
  return grid_over(scene.centre.array() - 1.2 * scene.radius, scene.centre.array() + 1.2 * scene.radius, grid,
                   Fill::full);
}

// The voxels whose centres are within `slack` voxels of being inside the ball.
VoxelGrid ball_of(const BallScene& scene, const VoxelGrid& like, double slack = 0) {
  VoxelGrid ball(like.size(), like.low(), like.spacing());
  for (int z = 0; z < ball.size().z(); ++z)
    for (int y = 0; y < ball.size().y(); ++y)
      for (int x = 0; x < ball.size().x(); ++x)
        ball.set(x, y, z, (ball.centre(x, y, z) - scene.centre).norm() < scene.radius + slack * ball.spacing());
  return ball;
}

double excess(const BallScene& scene, const VoxelGrid& grid) {
  return grid.volume() / (4.0 / 3 * M_PI * std::pow(scene.radius, 3)) - 1;
}

TEST(SilhouetteHull, HoldsTheBallAndFitsEveryMask) {
  const std::vector<Photo> photos = kStriped.photos(kFew);
  const VoxelGrid hull = silhouette_hull(photos, region(kStriped, 48));
  EXPECT_TRUE(contains(hull, ball_of(kStriped, hull, -1)));
  for (int z = 0; z < hull.size().z(); ++z)
    for (int y = 0; y < hull.size().y(); ++y)
      for (int x = 0; x < hull.size().x(); ++x) {
        if (!hull(x, y, z)) continue;
        for (const Photo& photo : photos) {
          const Vec2 at = project(photo.camera, hull.centre(x, y, z));
          ASSERT_EQ(photo.mask(static_cast<int>(at.x()), static_cast<int>(at.y())), 1);
        }
      }
}

TEST(SilhouetteHull, MorePhotosNeverAddAVoxel) {
  const std::vector<Photo> photos = kStriped.photos(kFew);
  VoxelGrid before = region(kStriped, 32);
  for (std::size_t n = 1; n <= photos.size(); ++n) {
    const VoxelGrid hull = silhouette_hull(std::span(photos).first(n), region(kStriped, 32));
    EXPECT_TRUE(contains(before, hull));
    before = hull;
  }
}

TEST(SilhouetteHull, OfManyPhotosConvergesToTheBall) {
  const std::vector<Photo> photos = kStriped.photos({.views = 41, .elevations = {"0", "30", "60", "-45"}, .size = 256});
  EXPECT_LT(std::abs(excess(kStriped, silhouette_hull(photos, region(kStriped, 64)))), 0.02);
}

// The visual hull of a ball from five photos is 6 % too large whatever the grid; its photo hull comes the nearer to the
// ball the smaller the voxels, and loses nothing that lies deeper than the size of a voxel.
TEST(SpaceCarving, ATexturedBallConvergesToItsPhotoHull) {
  const std::vector<Photo> photos = kStriped.photos(kFew);
  double before = 1;
  for (const int grid : {32, 64, 96}) {
    const VoxelGrid hull = silhouette_hull(photos, region(kStriped, grid));
    const SpaceCarving carved = space_carving(photos, hull, {.margin = 0});
    EXPECT_TRUE(carved.converged);
    EXPECT_TRUE(contains(hull, carved.grid));
    EXPECT_EQ(hull.count() - carved.grid.count(), carved.carved);
    EXPECT_TRUE(contains(carved.grid, ball_of(kStriped, hull, -1.8)));
    const double share = excess(kStriped, carved.grid) / excess(kStriped, hull);
    EXPECT_LT(share, before);
    before = share;
  }
  EXPECT_LT(before, 0.75);
}

// The photo hull is the union of all consistent shapes: those found from less of the start lie in it. But for single
// voxels: colours are ranges, which widen where less is hidden.
TEST(SpaceCarving, ItsPhotoHullHoldsTheConsistentShapesFoundElsewhere) {
  const std::vector<Photo> photos = kStriped.photos(kFew);
  const VoxelGrid start = silhouette_hull(photos, region(kStriped, 48));
  const VoxelGrid hull = space_carving(photos, start, {.margin = 0}).grid;
  const auto part = [&](auto&& keeps) {
    VoxelGrid grid = start;
    for (int z = 0; z < grid.size().z(); ++z)
      for (int y = 0; y < grid.size().y(); ++y)
        for (int x = 0; x < grid.size().x(); ++x)
          if (!keeps(grid.centre(x, y, z))) grid.set(x, y, z, false);
    return grid;
  };
  const auto off = [](const Vec3& p) { return (p - kStriped.centre).norm() - kStriped.radius; };
  for (const VoxelGrid& less :
       {part([](const Vec3& p) { return p.x() > 0; }), part([](const Vec3& p) { return p.y() > 0.3 || p.z() > 0; }),
        part([&](const Vec3& p) { return off(p) < 0.02; })}) {
    const VoxelGrid shape = space_carving(photos, less, {.margin = 0}).grid;
    EXPECT_GT(shape.count(), 10000);
    EXPECT_LT(shape.count(), less.count());
    EXPECT_NE(shape, hull);
    const double iou = intersection_over_union(shape, hull);
    const double common = iou / (1 + iou) * static_cast<double>(shape.count() + hull.count());
    EXPECT_GT(common, 0.999 * static_cast<double>(shape.count()));
  }
}

TEST(SpaceCarving, CarvingWhatWasCarvedChangesNothing) {
  const std::vector<Photo> photos = kStriped.photos(kFew);
  const SpaceCarving carved = space_carving(photos, silhouette_hull(photos, region(kStriped, 64)));
  EXPECT_GT(carved.carved, 0);
  const SpaceCarving again = space_carving(photos, carved.grid);
  EXPECT_EQ(again.grid, carved.grid);
  EXPECT_EQ(again.rounds, 1);
}

// Every photo shows other colours of one place: nothing is consistent.
TEST(SpaceCarving, LightThatMovesWithTheCameraCarvesEverything) {
  std::vector<Photo> photos = kStriped.photos({.views = 13, .size = 128});
  for (std::size_t i = 0; i < photos.size(); ++i)
    for (Rgba& p : photos[i].picture.pixels) p = {static_cast<std::uint8_t>(20 * i), 0, 0, 255};
  EXPECT_LT(space_carving(photos, silhouette_hull(photos, region(kStriped, 32))).grid.count(), 500);
}

TEST(SpaceCarving, WithoutTextureTheHullStays) {
  const BallScene flat;
  const std::vector<Photo> photos = flat.photos(kFew);
  const VoxelGrid hull = silhouette_hull(photos, region(flat, 40));
  EXPECT_EQ(space_carving(photos, hull).grid, hull);
}

TEST(SpaceCarving, ASmallerThresholdNeverKeepsMore) {
  const std::vector<Photo> photos = kStriped.photos(kFew);
  const VoxelGrid hull = silhouette_hull(photos, region(kStriped, 40));
  std::int64_t before = 0;
  for (const double threshold : {5.0, 10.0, 20.0, 60.0}) {
    const std::int64_t count = space_carving(photos, hull, {.threshold = threshold}).grid.count();
    EXPECT_LE(before, count);
    before = count;
  }
}

TEST(SpaceCarving, ThreadsDoNotChangeIt) {
  const std::vector<Photo> photos = kStriped.photos(kFew);
  const VoxelGrid hull = silhouette_hull(photos, region(kStriped, 40));
  set_thread_count(1);
  const VoxelGrid one = space_carving(photos, hull).grid;
  set_thread_count(4);
  EXPECT_EQ(space_carving(photos, hull).grid, one);
  set_thread_count(0);
}

TEST(SpaceCarving, RefusesPicturesOfAnotherSize) {
  std::vector<Photo> photos = kStriped.photos({.views = 2, .size = 16});
  photos[1].picture = Picture(8, 8);
  EXPECT_THROW(space_carving(photos, region(kStriped, 8)), std::invalid_argument);
  EXPECT_THROW(silhouette_hull(photos, region(kStriped, 8)), std::invalid_argument);
}

}  // namespace
}  // namespace carve
