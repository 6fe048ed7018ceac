#include "eval/rasterise.h"

#include <gtest/gtest.h>

#include "carve/core/parallel.h"
#include "eval/distance_transform.h"
#include "eval/meshes.h"

namespace carve {
namespace {

constexpr int kPixels = 64;
// [-1, 1] x [-1, 1] of the picture plane.
constexpr Window kWindow{kPixels, kPixels, -1, 2.0 / kPixels, 1, -2.0 / kPixels};

TEST(Camera, AxesAreRightHandedAndThoseOfTheViews) {
  for (const View view : kViews) {
    const CameraAxes c = camera(view);
    EXPECT_EQ(c.right.cross(c.up), c.toward) << name(view);
  }
  const CameraAxes front = camera(0, 0), side = camera(90, 0), top = camera(0, 90), any = camera(35, 22);
  EXPECT_NEAR((front.toward - camera(View::front).toward).norm(), 0, 1e-15);
  EXPECT_NEAR((side.right - camera(View::side).right).norm(), 0, 1e-15);
  EXPECT_NEAR((top.up - camera(View::top).up).norm(), 0, 1e-15);
  EXPECT_NEAR((any.right.cross(any.up) - any.toward).norm(), 0, 1e-15);
}

class Rasterise : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, Rasterise, testing::Range(0u, 8u));

TEST_P(Rasterise, ABallIsADiscOfItsDepthFromEverySide) {
  const CameraAxes axes = camera(40.0 * GetParam(), 30.0 * GetParam() - 90);
  const Seen seen = rasterise(ball(100, 0.8), axes, kWindow);
  for (int y = 0; y < kPixels; ++y)
    for (int x = 0; x < kPixels; ++x) {
      const double r = std::hypot((x + 0.5) * 2 / kPixels - 1, (y + 0.5) * 2 / kPixels - 1);
      if (r < 0.799) {
        EXPECT_NEAR(seen.depth(x, y), std::sqrt(0.64 - r * r), 0.02);
        EXPECT_GE(seen.triangle(x, y), 0);
      } else if (r > 0.8) {
        EXPECT_EQ(seen.depth(x, y), Seen::kNothing);
        EXPECT_EQ(seen.triangle(x, y), -1);
      }
    }
}

TEST_P(Rasterise, DoesNotDependOnTheThreads) {
  const Mesh mesh = rubble(500, GetParam());
  set_thread_count(1);
  const Seen one = rasterise(mesh, camera(View::front), kWindow);
  set_thread_count(4);
  const Seen four = rasterise(mesh, camera(View::front), kWindow);
  set_thread_count(0);
  EXPECT_EQ(one.depth, four.depth);
  EXPECT_EQ(one.triangle, four.triangle);
}

TEST(Rasterise, TheNearerTriangleIsSeenWhateverTheOrder) {
  Mesh mesh = joined(mapped(square(1), [](const Vec3& p) { return Vec3(p.x(), p.y(), -0.5); }), square(1));
  EXPECT_EQ(rasterise(mesh, camera(View::front), kWindow).depth(48, 16), 0);
  std::reverse(mesh.triangles.begin(), mesh.triangles.end());
  EXPECT_EQ(rasterise(mesh, camera(View::front), kWindow).depth(48, 16), 0);
  EXPECT_EQ(rasterise(mesh, camera(View::back), kWindow).depth(16, 16), 0.5);
}

TEST(Rasterise, NeighboursLeaveNoGap) {
  // Pixel centres fall on diagonals and sides.
  const Seen seen = rasterise(mapped(square(16), [](const Vec3& p) { return Vec3(2 * p - Vec3(1, 1, 0)); }),
                              camera(View::front), kWindow);
  for (const int triangle : seen.triangle.pixels) EXPECT_GE(triangle, 0);
}

TEST_P(Rasterise, DistanceTransformIsBruteForce) {
  std::mt19937 random(GetParam());
  Mask mask(37, 23);
  for (auto& pixel : mask.pixels) pixel = random() % (3 + 20 * GetParam()) == 0;
  const Raster<float> distance = distance_transform(mask);
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) {
      double nearest = std::numeric_limits<double>::infinity();
      for (int v = 0; v < mask.height; ++v)
        for (int u = 0; u < mask.width; ++u)
          if (mask(u, v)) nearest = std::min(nearest, std::hypot(x - u, y - v));
      ASSERT_FLOAT_EQ(distance(x, y), nearest) << x << " " << y;
    }
}

}  // namespace
}  // namespace carve
