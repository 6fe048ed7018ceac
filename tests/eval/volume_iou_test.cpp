#include "eval/volume_iou.h"

#include <gtest/gtest.h>

#include "carve/core/parallel.h"
#include "eval/meshes.h"

namespace carve {
namespace {

class VolumeIou : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, VolumeIou, testing::Range(0u, 8u));

TEST_P(VolumeIou, OfAMeshWithItselfIsOne) {
  const Mesh mesh = potato(20, GetParam());
  EXPECT_EQ(volume_iou(mesh, mesh, 50), 1);
}

TEST_P(VolumeIou, IsSymmetric) {
  const Mesh a = potato(20, GetParam()), b = potato(20, GetParam() + 1);
  EXPECT_EQ(volume_iou(a, b, 50), volume_iou(b, a, 50));
  EXPECT_LT(volume_iou(a, b, 50), 1);
}

TEST_P(VolumeIou, DoesNotDependOnTheThreads) {
  const Mesh a = potato(20, GetParam()), b = ball(20);
  set_thread_count(1);
  const double one = volume_iou(a, b, 64);
  set_thread_count(4);
  EXPECT_EQ(one, volume_iou(a, b, 64));
  set_thread_count(0);
}

TEST(VolumeIou, OfShiftedCubesIsThatOfTheirBoxes) {
  // Centres of cubes fall on faces, edges and corners of these meshes' triangulations.
  EXPECT_DOUBLE_EQ(volume_iou(cube(), cube({0.5, 0, 0}), 96), 1.0 / 3);
  EXPECT_DOUBLE_EQ(volume_iou(cube(), cube({0, 0.5, 0}), 96), 1.0 / 3);
  EXPECT_DOUBLE_EQ(volume_iou(cube(), cube({0, 0, 0.5}), 96), 1.0 / 3);
  EXPECT_EQ(volume_iou(cube(), cube({2, 0, 0}), 96), 0);
}

TEST(VolumeIou, ConvergesForBalls) {
  const double exact = 0.5 * 0.5 * 0.5;
  EXPECT_NEAR(volume_iou(ball(100), ball(100, 0.5), 64), exact, 3e-3);
  EXPECT_NEAR(volume_iou(ball(100), ball(100, 0.5), 256), exact, 3e-4);
}

TEST(VolumeIou, CountsInterpenetratingShellsOnceAndReversedOnesAsCavities) {
  const Mesh two = joined(cube(), cube({0.5, 0, 0}));
  const Mesh one = mapped(cube(), [](const Vec3& p) { return Vec3(1.5 * p.x() + 0.25, p.y(), p.z()); });
  EXPECT_EQ(volume_iou(two, one, 96), 1);
  const Mesh hollow = joined(cube(), turned_inside_out(cube(Vec3::Zero(), 0.5)));
  EXPECT_NEAR(volume_iou(hollow, cube(), 96), 1 - 1.0 / 8, 1e-12);
}

TEST(VolumeIou, RefusesResolutionsOutOfRange) {
  EXPECT_THROW(volume_iou(cube(), cube(), 0), std::invalid_argument);
  EXPECT_THROW(volume_iou(cube(), cube(), 4096), std::invalid_argument);
}

}  // namespace
}  // namespace carve
