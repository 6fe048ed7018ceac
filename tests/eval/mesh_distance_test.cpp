#include "eval/mesh_distance.h"

#include <gtest/gtest.h>

#include <limits>

#include "carve/core/parallel.h"
#include "eval/meshes.h"
#include "eval/point_triangle.h"

namespace carve {
namespace {

using Wide = Eigen::Matrix<long double, 3, 1>;

// Nearest point by regions, in long double, written without a look at the kernel.
long double exact_distance(const Vec3& point, const Vec3& ca, const Vec3& cb, const Vec3& cc) {
  const Wide p = point.cast<long double>(), a = ca.cast<long double>(), b = cb.cast<long double>(),
             c = cc.cast<long double>();
  const auto to_segment = [&p](const Wide& from, const Wide& to) {
    const Wide side = to - from;
    const long double length = side.squaredNorm();
    const long double t = length > 0 ? std::clamp((p - from).dot(side) / length, 0.0L, 1.0L) : 0.0L;
    return (p - from - t * side).norm();
  };
  long double best = std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)});
  const Wide n = (b - a).cross(c - a);
  if (n.squaredNorm() > 0 && n.dot((b - a).cross(p - a)) >= 0 && n.dot((c - b).cross(p - b)) >= 0 &&
      n.dot((a - c).cross(p - c)) >= 0)
    best = std::min(best, std::abs(n.dot(p - a)) / n.norm());
  return best;
}

Nearest by_brute_force(const Vec3& p, const Mesh& mesh) {
  double best = std::numeric_limits<double>::infinity();
  int nearest = -1;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    const double d = closest_on_triangle(p, mesh.positions[a], mesh.positions[b], mesh.positions[c]).squared_distance;
    if (d < best) best = d, nearest = static_cast<int>(t);
  }
  return {std::sqrt(best), nearest};
}

std::vector<Vec3> random_points(int count, unsigned seed, double reach) {
  std::mt19937 random(seed);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) points.push_back(random_point(random, reach));
  return points;
}

void expect_brute_force(const std::vector<Vec3>& points, const Mesh& mesh) {
  const std::vector<Nearest> nearest = MeshDistance(mesh).nearest(points);
  for (std::size_t i = 0; i < points.size(); ++i)
    ASSERT_EQ(nearest[i], by_brute_force(points[i], mesh)) << "point " << i;
}

class Distance : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, Distance, testing::Range(0u, 8u));

TEST_P(Distance, OfPointAndTriangleIsExactWhateverTheShape) {
  std::mt19937 random(GetParam());
  const Mesh mesh = rubble(500, GetParam());
  const double diagonal = 2 * std::sqrt(3);  // of the cube [-1, 1]^3 they lie in
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 &pa = mesh.positions[a], &pb = mesh.positions[b], &pc = mesh.positions[c];
    const double reach = std::pow(10.0, -static_cast<int>(random() % 7));
    const Vec3 p = pa + (pb - pa) * 0.4 + random_point(random, reach);
    const Footpoint foot = closest_on_triangle(p, pa, pb, pc);
    const double distance = std::sqrt(foot.squared_distance);
    ASSERT_NEAR(distance, static_cast<double>(exact_distance(p, pa, pb, pc)), 1e-15 * diagonal);
    ASSERT_NEAR((p - foot.point).norm(), distance, 1e-15 * diagonal);
  }
}

TEST_P(Distance, IsTheBruteForceMinimumBitForBit) {
  expect_brute_force(random_points(300, GetParam(), 2), potato(20, GetParam()));
  expect_brute_force(random_points(300, GetParam(), 1), rubble(700, GetParam()));
}

TEST_P(Distance, IsTheBruteForceMinimumOfPointsFarAway) {
  for (const double reach : {7.0, 20.0, 1e4, 1e12})
    expect_brute_force(random_points(40, GetParam(), reach), potato(12, GetParam()));
}

TEST_P(Distance, IsTheBruteForceMinimumOfTinyHugeAndDistantMeshes) {
  for (const double scale : {1e-60, 1e60})
    for (const double shift : {0.0, 1e3}) {
      const auto map = [=](const Vec3& p) { return Vec3(scale * (p + Vec3::Constant(shift))); };
      std::vector<Vec3> points = random_points(40, GetParam(), 2);
      for (Vec3& p : points) p = map(p);
      expect_brute_force(points, mapped(potato(12, GetParam()), map));
    }
}

TEST_P(Distance, OfManyTrianglesAtOnePlaceIsTheLowestIndex) {
  Mesh mesh = square(1);
  for (int i = 0; i < 300; ++i) mesh.triangles.push_back(mesh.triangles[i % 2]);
  expect_brute_force(random_points(50, GetParam(), 2), mesh);
}

// On a lattice points lie exactly in the planes and on the lines of triangles that are points or segments.
TEST_P(Distance, IsTheBruteForceMinimumOnALattice) {
  std::mt19937 random(GetParam());
  const auto corner = [&] { return Vec3(random() % 9 / 8.0, random() % 9 / 8.0, random() % 9 / 8.0); };
  Mesh mesh;
  for (int i = 0; i < 200; ++i) {
    const Vec3 a = corner(), b = corner();
    const Vec3 c[] = {a, b, a + 0.25 * (b - a), corner()};
    for (const Vec3& p : {a, random() % 2 ? a : b, c[random() % 4]}) mesh.positions.push_back(p);
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  std::vector<Vec3> points;
  for (int i = 0; i < 300; ++i) points.push_back(corner());
  expect_brute_force(points, mesh);
}

TEST_P(Distance, OfCornersIsZero) {
  const Mesh mesh = rubble(400, GetParam());
  for (const Nearest& n : MeshDistance(mesh).nearest(mesh.positions)) ASSERT_EQ(n.distance, 0);
}

TEST_P(Distance, DoesNotDependOnTheThreads) {
  const Mesh mesh = potato(40, GetParam());
  const std::vector<Vec3> points = random_points(20000, GetParam(), 2);
  const MeshDistance distance(mesh);
  set_thread_count(1);
  const auto one = distance.nearest(points);
  set_thread_count(4);
  EXPECT_EQ(one, distance.nearest(points));
  set_thread_count(0);
}

TEST(Distance, ToABallIsThatToItsRadius) {
  std::mt19937 random(1);
  for (const double& d : distances(random_points(200, 1, 0.3), ball(100))) EXPECT_NEAR(d, 0.75, 0.3);
  const Vec3 p = 2 * random_point(random).normalized();
  EXPECT_NEAR(distances(std::vector{p}, ball(200))[0], 1, 3e-4);
}

TEST(Distance, RefusesWhatHasNoAnswer) {
  EXPECT_THROW(MeshDistance({}), std::invalid_argument);
  EXPECT_THROW(MeshDistance(Mesh{{Vec3::Zero()}, {{0, 0, 1}}}), std::invalid_argument);
  EXPECT_THROW(MeshDistance(Mesh{{Vec3::Constant(std::nan(""))}, {{0, 0, 0}}}), std::invalid_argument);
  EXPECT_THROW(MeshDistance(cube()).nearest(std::vector{Vec3(0, 1e101, 0)}), std::invalid_argument);
  EXPECT_TRUE(MeshDistance(cube()).nearest({}).empty());
}

}  // namespace
}  // namespace carve
