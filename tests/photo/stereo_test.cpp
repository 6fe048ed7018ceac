#include "carve/photo/stereo.h"

#include <gmock/gmock.h>

#include "carve/core/error.h"
#include "carve/core/parallel.h"
#include "carve/mesh/topology.h"
#include "carve/photo/poisson.h"
#include "photo/ball_photos.h"

namespace carve {
namespace {

const BallScene kBall{.colour = striped};
const Vec3 kLow(-0.55, -0.05, -0.55), kHigh(0.55, 1.05, 0.55);
const RigOptions kRing{.views = 24, .top = false, .size = 192};

double mean_error(const OrientedPoints& points) {
  double sum = 0;
  for (const Vec3& p : points.positions) sum += std::abs((p - kBall.centre).norm() - kBall.radius);
  return sum / static_cast<double>(points.positions.size());
}

OrientedPoints points_on_ball(int count) {
  OrientedPoints points;
  for (int i = 0; i < count; ++i) {
    const double y = 1 - 2 * (i + 0.5) / count, r = std::sqrt(1 - y * y), turn = 2.399963 * i;
    const Vec3 n(r * std::cos(turn), y, r * std::sin(turn));
    points.normals.push_back(n);
    points.positions.push_back(kBall.centre + kBall.radius * n);
  }
  return points;
}

TEST(Stereo, EveryPhotoOfARingIsPairedOnce) {
  EXPECT_EQ(depth_maps(kBall.photos(kRing), kLow, kHigh).size(), 24u);
  EXPECT_EQ(depth_maps(kBall.photos(kRing), kLow, kHigh, {.angle = 14}).size(), 0u);  // they are 15 degrees apart
}

TEST(Stereo, DepthsAreTheBalls) {
  const std::vector<Photo> photos = kBall.photos(kRing);
  const DepthMap map = depth_maps(photos, kLow, kHigh)[0];
  EXPECT_LT((map.camera.centre() - photos[0].camera.centre()).norm(), 1e-9);
  int right = 0, known = 0;
  for (int j = 0; j < map.depth.height; ++j)
    for (int i = 0; i < map.depth.width; ++i) {
      const auto place = kBall.hit(map.camera, {i + 0.5, j + 0.5});
      if (!place || map.depth(i, j) <= 0) continue;
      ++known;
      right += std::abs(map.camera.in_camera(*place).z() - map.depth(i, j)) < 0.02;
    }
  EXPECT_GT(known, 3000);
  EXPECT_GT(right, 0.8 * known);  // not near the rim, where windows see two depths
}

TEST(Stereo, FusedPointsLieOnTheBallAndTheirNormalsPointOut) {
  const OrientedPoints points = fuse(depth_maps(kBall.photos(kRing), kLow, kHigh), kLow, kHigh);
  ASSERT_GT(points.positions.size(), 3000u);
  EXPECT_LT(mean_error(points), 0.01);  // a pixel of disparity is 0.03 deep
  int out = 0;
  for (std::size_t i = 0; i < points.positions.size(); ++i)
    out += points.normals[i].dot(points.positions[i] - kBall.centre) > 0.8 * kBall.radius;
  EXPECT_GT(out, 0.95 * static_cast<double>(points.positions.size()));
}

TEST(Stereo, MoreSupportNeverAddsPoints) {
  const std::vector<DepthMap> maps = depth_maps(kBall.photos(kRing), kLow, kHigh);
  std::size_t before = 1u << 30;
  for (const int support : {0, 1, 2, 4}) {
    const std::size_t count = fuse(maps, kLow, kHigh, {.support = support}).positions.size();
    EXPECT_LE(count, before);
    before = count;
  }
}

TEST(Stereo, WithoutTextureThereAreNoPointsInside) {
  const BallScene flat;
  const std::vector<Photo> photos = flat.photos(kRing);
  const DepthMap map = depth_maps(photos, kLow, kHigh)[0];
  const Vec2 middle = project(map.camera, flat.centre);
  for (int k = -10; k <= 10; ++k)
    EXPECT_EQ(map.depth(static_cast<int>(middle.x()) + k, static_cast<int>(middle.y())), 0);
}

TEST(Stereo, ThreadsDoNotChangeAPoint) {
  const std::vector<Photo> photos = kBall.photos({.views = 12, .top = false, .size = 128});
  set_thread_count(1);
  const OrientedPoints one = fuse(depth_maps(photos, kLow, kHigh), kLow, kHigh);
  set_thread_count(4);
  const OrientedPoints four = fuse(depth_maps(photos, kLow, kHigh), kLow, kHigh);
  set_thread_count(0);
  EXPECT_EQ(one.positions, four.positions);
  EXPECT_EQ(one.normals, four.normals);
}

TEST(Stereo, RefusesOptionsOutOfRange) {
  const std::vector<Photo> photos = kBall.photos({.views = 2, .top = false, .size = 32});
  EXPECT_THROW(depth_maps(photos, kLow, kHigh, {.window = 4}), std::invalid_argument);
  EXPECT_THROW(depth_maps(photos, kLow, kHigh, {.angle = 90}), std::invalid_argument);
  EXPECT_THROW(fuse({}, kLow, kHigh, {.spacing = 0}), std::invalid_argument);
}

TEST(Poisson, ASurfaceThroughPointsOfABallIsTheBall) {
  const Mesh mesh = poisson_surface(points_on_ball(2000), grid_over(kLow, kHigh, 48));
  const Topology found = topology(mesh);
  EXPECT_TRUE(found.solid());
  EXPECT_EQ(found.components, 1);
  EXPECT_NEAR(found.volume, M_PI / 6, 0.01);
  EXPECT_EQ(topology(poisson_surface(points_on_ball(1100), grid_over(kLow, kHigh, 24))).components, 1);  // the fewest
  double worst = 0;
  for (const Vec3& p : mesh.positions) worst = std::max(worst, std::abs((p - kBall.centre).norm() - kBall.radius));
  EXPECT_LT(worst, 0.012);  // half a voxel; far less than marching cubes with vertices in the middles would give
}

TEST(Poisson, IsTheSameEveryTime) {
  const OrientedPoints points = points_on_ball(1500);
  const VoxelGrid region = grid_over(kLow, kHigh, 24);
  EXPECT_EQ(poisson_surface(points, region), poisson_surface(points, region));
}

// Many points at nearly one place are as good as one of them.
TEST(Poisson, PointsThatNearlyCoincideDoNoHarm) {
  OrientedPoints points = points_on_ball(2000);
  for (int i = 0; i < 2000; ++i)
    for (const Vec3& off : {Vec3(1e-9, 0, 0), Vec3(1e-9, 1e-9, 0), Vec3(0, 1e-9, 0)}) {
      points.positions.push_back(points.positions[i] + off);
      points.normals.push_back(points.normals[i]);
    }
  EXPECT_NEAR(topology(poisson_surface(points, grid_over(kLow, kHigh, 32))).volume, M_PI / 6, 0.02);
}

TEST(Poisson, FewPointsAreNoSurface) {
  EXPECT_THROW(poisson_surface(points_on_ball(1000), grid_over(kLow, kHigh, 8)), NoResult);
  EXPECT_THROW(poisson_surface({}, grid_over(kLow, kHigh, 8)), NoResult);
}

}  // namespace
}  // namespace carve
