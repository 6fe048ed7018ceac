#include "eval/signed_distance.h"

#include <gtest/gtest.h>

#include "eval/meshes.h"

namespace carve {
namespace {

std::vector<double> signs(const std::vector<Vec3>& points, const Mesh& mesh, SignRule rule = SignRule::pseudo_normal) {
  return signed_distances(points, MeshDistance(mesh).nearest(points), mesh, rule);
}

class SignedDistance : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, SignedDistance, testing::Range(0u, 8u));

TEST_P(SignedDistance, IsNegativeInsideACube) {
  std::mt19937 random(GetParam());
  std::vector<Vec3> points;
  for (int i = 0; i < 2000; ++i) points.push_back(random_point(random, 0.8));
  const auto d = signs(points, cube());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 beyond = points[i].cwiseAbs().array() - 0.5;
    const double expected = beyond.maxCoeff() > 0 ? beyond.cwiseMax(0).norm() : beyond.maxCoeff();
    ASSERT_NEAR(d[i], expected, 1e-15) << points[i].transpose();
  }
}

// Corners whose faces turn their backs on some of the points they are nearest to.
Mesh spike() {
  Mesh mesh{{{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {3, 3, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  return mesh;
}

TEST_P(SignedDistance, IsPositiveOutsideASpikeOnlyByThePseudoNormal) {
  std::mt19937 random(GetParam());
  std::vector<Vec3> points;
  for (int i = 0; i < 2000; ++i) points.push_back(Vec3(3, 3, 1) + Vec3(1, 1, 1) + random_point(random, 1));
  int wrong = 0;
  for (const double d : signs(points, spike())) EXPECT_GT(d, 0);
  for (const double d : signs(points, spike(), SignRule::nearest_face)) wrong += d < 0;
  EXPECT_GT(wrong, 100);
}

TEST_P(SignedDistance, FlipsWithTheTriangles) {
  std::mt19937 random(GetParam());
  const Mesh mesh = potato(20, GetParam());
  std::vector<Vec3> points;
  for (int i = 0; i < 500; ++i) points.push_back(random_point(random, 2));
  const auto outside = signs(points, mesh), inside = signs(points, turned_inside_out(mesh));
  for (std::size_t i = 0; i < points.size(); ++i) ASSERT_NEAR(outside[i], -inside[i], 1e-15);
}

TEST_P(SignedDistance, OfATriangleSoupIsThatOfItsMesh) {
  std::mt19937 random(GetParam());
  const Mesh mesh = spike();
  Mesh soup;
  for (const Triangle& triangle : mesh.triangles) {
    const int first = static_cast<int>(soup.positions.size());
    for (const int corner : triangle) soup.positions.push_back(mesh.positions[corner]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  std::vector<Vec3> points;
  for (int i = 0; i < 500; ++i) points.push_back(random_point(random, 5));
  EXPECT_EQ(signs(points, mesh), signs(points, soup));
}

}  // namespace
}  // namespace carve
