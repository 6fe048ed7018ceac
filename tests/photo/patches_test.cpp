#include "carve/photo/patches.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>

#include "carve/core/error.h"
#include "carve/core/parallel.h"
#include "carve/core/random.h"
#include "carve/photo/poisson.h"
#include "photo/ball_photos.h"

namespace carve {
namespace {

const BallScene kBall{.colour = striped};
const Vec3 kLow(-0.55, -0.05, -0.55), kHigh(0.55, 1.05, 0.55);
const RigOptions kRing{.views = 12, .top = false, .step = 15, .size = 160};

double error(const Vec3& p) { return std::abs((p - kBall.centre).norm() - kBall.radius); }

// A square of side 1 about the origin that faces (0.2, 0.1, 1), seen by five cameras.
const Vec3 kFacing = Vec3(0.2, 0.1, 1).normalized();

std::vector<Photo> photos_of_square() {
  const Vec3 right = Vec3(0, 1, 0).cross(kFacing).normalized(), up = kFacing.cross(right);
  std::vector<Photo> photos;
  for (const double x : {-1.2, -0.6, 0.0, 0.6, 1.2}) {
    const Camera camera = look_at({x, 0.2, 3}, Vec3::Zero(), {0, 1, 0}, 160, 160, 25);
    Photo photo{camera, Picture(160, 160, {0, 0, 0, 255}), Mask(160, 160)};
    for (int j = 0; j < 160; ++j)
      for (int i = 0; i < 160; ++i) {
        const Vec3 d = ray(camera, {i + 0.5, j + 0.5});
        const Vec3 p = camera.centre() - camera.centre().dot(kFacing) / d.dot(kFacing) * d;
        if (std::abs(p.dot(right)) > 0.5 || std::abs(p.dot(up)) > 0.5) continue;
        photo.picture(i, j) = striped(p), photo.mask(i, j) = 1;
      }
    photos.push_back(std::move(photo));
  }
  return photos;
}

// A pixel of the halved photos is 0.017 wide there.
TEST(Patches, OfASquareLieOnItAndFaceAsItDoes) {
  const OrientedPoints points = patches(photos_of_square(), Vec3::Constant(-0.7), Vec3::Constant(0.7));
  ASSERT_GT(points.positions.size(), 300u);
  std::size_t near = 0, straight = 0;
  for (std::size_t i = 0; i < points.positions.size(); ++i) {
    near += std::abs(points.positions[i].dot(kFacing)) < 0.005;
    straight += points.normals[i].dot(kFacing) > std::cos(10 * M_PI / 180);
    EXPECT_LT(std::abs(points.positions[i].dot(kFacing)), 0.02);
  }
  EXPECT_GT(near, 0.95 * static_cast<double>(points.positions.size()));
  EXPECT_GT(straight, 0.95 * static_cast<double>(points.positions.size()));
}

TEST(Patches, OfABallLieOnItAndFaceOutwards) {
  const OrientedPoints points = patches(kBall.photos(kRing), kLow, kHigh);
  ASSERT_GT(points.positions.size(), 1000u);
  double sum = 0;
  std::size_t straight = 0;
  for (std::size_t i = 0; i < points.positions.size(); ++i) {
    sum += error(points.positions[i]);
    straight += points.normals[i].dot((points.positions[i] - kBall.centre).normalized()) > std::cos(15 * M_PI / 180);
    EXPECT_NEAR(points.normals[i].norm(), 1, 1e-9);
  }
  EXPECT_LT(sum / static_cast<double>(points.positions.size()), 0.0065);  // half a pixel of the halved photos
  EXPECT_GT(straight, 0.95 * static_cast<double>(points.positions.size()));
}

TEST(Patches, MatchedFeaturesAreSeenWhereTheySaySo) {
  const std::vector<Photo> photos = kBall.photos(kRing);
  const std::vector<SeenPoint> points = matched_features(photos, kLow, kHigh);
  ASSERT_GT(points.size(), 100u);
  for (const SeenPoint& point : points) {
    EXPECT_LT(error(point.position), 0.03);
    EXPECT_GE(point.photos.size(), 3u);
    for (const int i : point.photos)
      EXPECT_GT((point.position - kBall.centre).dot(photos[i].camera.centre() - point.position), 0);
  }
}

TEST(Patches, WithoutTextureThereAreNone) {
  const std::vector<Photo> photos = BallScene{}.photos(kRing);
  const OrientedPoints points = patches(photos, kLow, kHigh);
  EXPECT_TRUE(points.positions.empty());
  EXPECT_THROW(poisson_surface(points, grid_over(kLow, kHigh, 8)), NoResult);
}

// Every photo shows noise of its own: windows agree by chance only.
TEST(Patches, PhotosThatHaveNothingInCommonMakeNone) {
  std::vector<Photo> photos = kBall.photos(kRing);
  Random random(3);
  for (Photo& photo : photos)
    for (Rgba& p : photo.picture.pixels) p.r = p.g = p.b = static_cast<std::uint8_t>(random.below(256));
  EXPECT_TRUE(patches(photos, kLow, kHigh).positions.empty());
}

TEST(Patches, LieInTheBox) {
  const Vec3 high(kHigh.x(), 0.5, kHigh.z());
  const OrientedPoints points = patches(kBall.photos(kRing), kLow, high);
  EXPECT_GT(points.positions.size(), 200u);
  for (const Vec3& p : points.positions) EXPECT_TRUE((p.array() <= high.array()).all());
}

TEST(Patches, ThreadsDoNotChangeAPoint) {
  const std::vector<Photo> photos = kBall.photos({.views = 6, .top = false, .step = 15, .size = 128});
  set_thread_count(1);
  const OrientedPoints one = patches(photos, kLow, kHigh, {.rounds = 2});
  set_thread_count(2);
  const OrientedPoints two = patches(photos, kLow, kHigh, {.rounds = 2});
  set_thread_count(0);
  EXPECT_GT(one.positions.size(), 100u);
  EXPECT_EQ(one.positions, two.positions);
  EXPECT_EQ(one.normals, two.normals);
}

TEST(Patches, NeedAsManyPhotosAsMustAgree) {
  const std::vector<Photo> photos = kBall.photos({.views = 4, .top = false, .step = 15, .size = 128});
  EXPECT_GT(patches(photos, kLow, kHigh, {.min_image_num = 3}).positions.size(), 100u);
  EXPECT_TRUE(patches(photos, kLow, kHigh, {.min_image_num = 5}).positions.empty());
  EXPECT_TRUE(patches({}, kLow, kHigh).positions.empty());
}

TEST(Patches, RefuseOptionsOutOfRange) {
  const std::vector<Photo> photos = kBall.photos({.views = 3, .top = false, .size = 32});
  EXPECT_THROW(patches(photos, kLow, kHigh, {.wsize = 8}), std::invalid_argument);
  EXPECT_THROW(patches(photos, kLow, kHigh, {.level = 3}), std::invalid_argument);  // 4 pixels wide
  EXPECT_THROW(patches(photos, kLow, kHigh, {.threshold = 1.5}), std::invalid_argument);
  EXPECT_THROW(patches(photos, kLow, kHigh, {.angle = 90}), std::invalid_argument);
}

}  // namespace
}  // namespace carve
