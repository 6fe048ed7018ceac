#include "carve/photo/camera.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <random>

#include "carve/photo/rig.h"

namespace carve {
namespace {

const Vec3 kLow(-0.3, 0, -0.5), kHigh(0.3, 0.8, 0.5);

MATCHER_P2(IsNear, expected, tolerance, "") { return (arg - expected).norm() <= tolerance; }

TEST(Camera, ProjectsKnownPoints) {
  // 90 degrees across 200 pixels: focal 100; at depth 2 a unit is 50 pixels.
  const Camera camera = look_at({0, 0, 2}, {0, 0, 0}, {0, 1, 0}, 200, 100, 90);
  EXPECT_THAT(project(camera, {0, 0, 0}), IsNear(Vec2(100, 50), 0.01));
  EXPECT_THAT(project(camera, {1, 0, 0}), IsNear(Vec2(150, 50), 0.01));
  EXPECT_THAT(project(camera, {0, 1, 0}), IsNear(Vec2(100, 0), 0.01));
  EXPECT_THAT(project(camera, {1, 1, 1}), IsNear(Vec2(200, -50), 0.01));
}

TEST(Camera, MatrixAndFunctionAgree) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-0.5, 0.5);
  for (const Camera& camera : rig(kLow, kHigh, {.views = 7, .elevations = {"0", "40"}}))
    for (int i = 0; i < 20; ++i) {
      const Vec3 x(unit(random), unit(random), unit(random));
      EXPECT_THAT(Vec2((projection(camera) * x.homogeneous()).hnormalized()), IsNear(project(camera, x), 1e-9));
    }
}

TEST(Camera, RayPassesThroughWhatThePixelShows) {
  for (const Camera& camera : rig(kLow, kHigh, {.views = 5})) {
    const Vec3 x(0.1, 0.2, -0.3);
    const double depth = camera.in_camera(x).z();
    EXPECT_THAT(Vec3(camera.centre() + depth * ray(camera, project(camera, x))), IsNear(x, 1e-9));
  }
}

TEST(Camera, RotationIsOne) {
  for (const Camera& camera : rig(kLow, kHigh, {.views = 9, .elevations = {"-20", "0", "60"}})) {
    EXPECT_LT((camera.rotation * camera.rotation.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(camera.rotation.determinant(), 1, 1e-12);
  }
}

TEST(Camera, RefusesWhatCannotLook) {
  EXPECT_THROW(look_at({0, 0, 0}, {0, 0, 0}, {0, 1, 0}, 10, 10, 30), std::invalid_argument);
  EXPECT_THROW(look_at({0, 1, 0}, {0, 0, 0}, {0, 1, 0}, 10, 10, 30), std::invalid_argument);
  EXPECT_THROW(look_at({0, 0, 1}, {0, 0, 0}, {0, 1, 0}, 0, 10, 30), std::invalid_argument);
  EXPECT_THROW(look_at({0, 0, 1}, {0, 0, 0}, {0, 1, 0}, 10, 10, 180), std::invalid_argument);
}

TEST(Rig, ThesisHas36AtGroundLevelAndOneAbove) {
  const std::vector<Camera> cameras = rig(kLow, kHigh);
  ASSERT_EQ(cameras.size(), 37u);
  const Vec3 middle = (kLow + kHigh) / 2;
  const double distance = (cameras[0].centre() - middle).norm();
  for (int i = 0; i < 36; ++i) {
    EXPECT_NEAR(cameras[i].centre().y(), middle.y(), 1e-9);
    EXPECT_NEAR((cameras[i].centre() - cameras[(i + 1) % 36].centre()).norm(), 2 * distance * std::sin(M_PI / 36),
                1e-9);
  }
  EXPECT_THAT(cameras[36].centre(), IsNear(Vec3(0, middle.y() + distance, 0), 1e-9));
}

TEST(Rig, ThreeViewsLookAsTheDrawingsDo) {
  const std::vector<Camera> cameras = rig(kLow, kHigh, {.views = 3});
  const auto right_and_up = [&](int i) {
    return std::pair<Vec3, Vec3>(cameras[i].rotation.row(0), -cameras[i].rotation.row(1));
  };
  EXPECT_THAT(right_and_up(0).first, IsNear(Vec3(1, 0, 0), 1e-12));   // front
  EXPECT_THAT(right_and_up(1).first, IsNear(Vec3(0, 0, -1), 1e-12));  // side
  EXPECT_THAT(right_and_up(2).first, IsNear(Vec3(1, 0, 0), 1e-12));   // top
  EXPECT_THAT(right_and_up(1).second, IsNear(Vec3(0, 1, 0), 1e-12));
  EXPECT_THAT(right_and_up(2).second, IsNear(Vec3(0, 0, -1), 1e-12));
}

TEST(Rig, EveryCornerOfTheBoxIsInEveryPicture) {
  for (const Camera& camera : rig(kLow, kHigh, {.views = 13, .elevations = {"-30", "0", "75"}, .size = 64}))
    for (int corner = 0; corner < 8; ++corner) {
      const Vec2 at = project(camera, {corner & 1 ? kLow.x() : kHigh.x(), corner & 2 ? kLow.y() : kHigh.y(),
                                       corner & 4 ? kLow.z() : kHigh.z()});
      EXPECT_GT(at.minCoeff(), 0);
      EXPECT_LT(at.maxCoeff(), 64);
    }
}

TEST(Rig, RefusesOptionsOutOfRange) {
  EXPECT_THROW(rig(kLow, kHigh, {.views = 0}), std::invalid_argument);
  EXPECT_THROW(rig(kLow, kHigh, {.elevations = {"90"}}), std::invalid_argument);
  EXPECT_THROW(rig(kLow, kHigh, {.elevations = {}}), std::invalid_argument);
  EXPECT_THROW(rig(kLow, kLow), std::invalid_argument);
}

TEST(PoseNoise, NoneIsTheIdentityAndSeedsRepeat) {
  const std::vector<Camera> cameras = rig(kLow, kHigh, {.views = 5});
  const PoseNoiseOptions one{.rotation = 1, .position = 1, .seed = 1}, two{.rotation = 1, .position = 1, .seed = 2};
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const Camera same = with_pose_noise(cameras, Vec3::Zero())[i];
    EXPECT_EQ(same.rotation, cameras[i].rotation);
    EXPECT_THAT(same.translation, IsNear(cameras[i].translation, 1e-12));
  }
  EXPECT_EQ(with_pose_noise(cameras, Vec3::Zero(), one), with_pose_noise(cameras, Vec3::Zero(), one));
  EXPECT_NE(with_pose_noise(cameras, Vec3::Zero(), one), with_pose_noise(cameras, Vec3::Zero(), two));
}

TEST(PoseNoise, HasTheDeviationAskedFor) {
  const std::vector<Camera> cameras(2000, rig(kLow, kHigh, {.views = 1})[0]);
  const Vec3 middle = (kLow + kHigh) / 2;
  const double distance = (cameras[0].centre() - middle).norm();
  double turned = 0, moved = 0;
  for (const Camera& camera : with_pose_noise(cameras, middle, {.rotation = 2, .position = 3})) {
    turned += std::pow(Eigen::AngleAxisd(camera.rotation * cameras[0].rotation.transpose()).angle() * 180 / M_PI, 2);
    moved += (camera.centre() - cameras[0].centre()).squaredNorm() / 3;
  }
  EXPECT_NEAR(std::sqrt(turned / 2000), 2, 0.15);
  EXPECT_NEAR(std::sqrt(moved / 2000) / distance * 100, 3, 0.2);
}

}  // namespace
}  // namespace carve
