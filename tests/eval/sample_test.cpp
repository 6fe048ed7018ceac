#include "eval/sample.h"

#include <gtest/gtest.h>

#include <map>

#include "carve/core/parallel.h"
#include "eval/meshes.h"
#include "eval/point_triangle.h"

namespace carve {
namespace {

class Sampling : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, Sampling, testing::Range(0u, 8u));

TEST_P(Sampling, PointsLieOnTheirTriangles) {
  const Mesh mesh = potato(10, GetParam());
  const Samples samples = sample_surface(mesh, 1000, GetParam());
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    const auto [a, b, c] = mesh.triangles[samples.triangles[i]];
    ASSERT_LT(closest_on_triangle(samples.points[i], mesh.positions[a], mesh.positions[b], mesh.positions[c])
                  .squared_distance,
              1e-30);
  }
}

TEST_P(Sampling, EveryTriangleGetsItsShareOfTheArea) {
  Mesh mesh = square(4);
  for (Vec3& p : mesh.positions) p.x() *= p.x();  // areas 1 : 3 : 5 : 7
  const int count = 3200;
  std::map<int, int> hits;
  for (const int triangle : sample_surface(mesh, count, GetParam()).triangles) ++hits[triangle];
  for (int t = 0; t < 32; ++t) EXPECT_NEAR(hits[t], count * (2 * (t / 2 % 4) + 1) / 16.0 / 8, 1.01) << t;
}

TEST_P(Sampling, IsUniformWithinATriangle) {
  const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  Vec3 mean = Vec3::Zero();
  int near_corner = 0;
  const Samples samples = sample_surface(mesh, 40000, GetParam());
  for (const Vec3& p : samples.points) {
    mean += p / 40000;
    near_corner += p.x() + p.y() < 0.5;
  }
  EXPECT_NEAR((mean - Vec3(1, 1, 0) / 3).norm(), 0, 0.005);
  EXPECT_NEAR(near_corner / 40000.0, 0.25, 0.01);
}

TEST_P(Sampling, DependsOnTheSeedAndNotOnTheThreads) {
  const Mesh mesh = potato(10, 1);
  set_thread_count(1);
  const Samples one = sample_surface(mesh, 50000, GetParam());
  set_thread_count(4);
  EXPECT_EQ(one.points, sample_surface(mesh, 50000, GetParam()).points);
  set_thread_count(0);
  EXPECT_NE(one.points, sample_surface(mesh, 50000, GetParam() + 1).points);
}

TEST(Sampling, SkipsTrianglesWithoutAreaAndRefusesMeshesWithout) {
  Mesh mesh = square(1);
  mesh.triangles.push_back({0, 0, 1});
  mesh.triangles.insert(mesh.triangles.begin(), {0, 0, 0});
  for (const int triangle : sample_surface(mesh, 1000, 1).triangles) EXPECT_TRUE(triangle == 1 || triangle == 2);
  mesh.triangles = {{0, 0, 1}};
  EXPECT_THROW(sample_surface(mesh, 10, 1), std::invalid_argument);
  EXPECT_THROW(sample_surface({}, 10, 1), std::invalid_argument);
  EXPECT_THROW(sample_surface(square(1), 0, 1), std::invalid_argument);
}

}  // namespace
}  // namespace carve
