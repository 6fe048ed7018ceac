#include "carve/surface/smooth.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "carve/carving/carve_silhouettes.h"
#include "carve/core/parallel.h"
#include "carve/mesh/topology.h"
#include "carve/surface/marching_cubes.h"
#include "carve/surface/sharpen.h"
#include "mesh/solids.h"
#include "shapes.h"

namespace carve {
namespace {

class SmoothTest : public ::testing::TestWithParam<unsigned> {
 protected:
  Mesh noisy() const { return shaken(ball_mesh(3), GetParam(), 0.02); }
};
INSTANTIATE_TEST_SUITE_P(Seeds, SmoothTest, ::testing::Range(0u, 8u));

double largest_difference(const Mesh& a, const Mesh& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.positions.size(); ++i)
    most = std::max(most, (a.positions[i] - b.positions[i]).cwiseAbs().maxCoeff());
  return most;
}

TEST_P(SmoothTest, ZeroStepsOrLevelIsTheIdentity) {
  const Mesh mesh = noisy();
  EXPECT_EQ(smooth(mesh, {.steps = 0}), mesh);
  EXPECT_EQ(smooth(mesh, {.steps = 5, .level = 0}), mesh);
}

TEST_P(SmoothTest, AStepMovesEveryVertexToTheMeanOfItsNeighbours) {
  const Mesh mesh = noisy(), moved = smooth(mesh, {.steps = 1});
  std::vector<std::vector<int>> rings(mesh.positions.size());
  for (const Triangle& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) rings[t[i]].push_back(t[(i + 1) % 3]);  // once each on a closed surface
  for (std::size_t v = 0; v < rings.size(); ++v) {
    Vec3 mean = Vec3::Zero();
    for (const int other : rings[v]) mean += mesh.positions[other] / static_cast<double>(rings[v].size());
    EXPECT_LT((moved.positions[v] - mean).norm(), 1e-14);
  }
}

TEST_P(SmoothTest, KeepsTriangles) { EXPECT_EQ(smooth(noisy(), {.steps = 7}).triangles, noisy().triangles); }

TEST_P(SmoothTest, FollowsTranslationAndScale) {
  const Mesh mesh = noisy();
  Mesh placed = mesh, expected = smooth(mesh, {.steps = 4, .level = 30});
  for (Mesh* each : {&placed, &expected})
    for (Vec3& p : each->positions) p = 4 * p + Vec3(1, -2, 3);
  EXPECT_LT(largest_difference(smooth(placed, {.steps = 4, .level = 30}), expected), 1e-13);
}

TEST_P(SmoothTest, APlaneStaysExactlyPlane) {
  constexpr int kSide = 12;
  Mesh sheet;
  std::mt19937 random(GetParam());
  std::uniform_real_distribution<double> at(0, 1);
  for (int i = 0; i < kSide * kSide; ++i) sheet.positions.emplace_back(at(random), 0.1, at(random));
  for (int y = 0; y + 1 < kSide; ++y)
    for (int x = 0; x + 1 < kSide; ++x) {
      const int a = y * kSide + x;
      sheet.triangles.push_back({a, a + kSide, a + 1});
      sheet.triangles.push_back({a + 1, a + kSide, a + kSide + 1});
    }
  for (const Vec3& p : smooth(sheet, {.steps = 9}).positions) EXPECT_EQ(p.y(), 0.1);
}

TEST_P(SmoothTest, ThreadsDoNotChangeABit) {
  const Mesh mesh = shaken(ball_mesh(6), GetParam(), 0.005);
  const SmoothOptions options{.steps = 3, .level = 20};
  set_thread_count(1);
  const Mesh one = smooth(mesh, options);
  set_thread_count(4);
  const Mesh four = smooth(mesh, options);
  set_thread_count(0);
  EXPECT_EQ(one, four);
}

// A box with each face a grid: all its edges are right angles, its faces plane.
Mesh grid_box(int n) {
  Mesh box;
  std::map<std::array<int, 3>, int> known;
  const auto vertex = [&](std::array<int, 3> at) {
    const auto [found, is_new] = known.try_emplace(at, static_cast<int>(box.positions.size()));
    if (is_new) box.positions.push_back(Vec3(at[0], at[1], at[2]) / n);
    return found->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const int end : {0, n})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto corner = [&](int u, int v) {
            std::array<int, 3> at{};
            at[axis] = end, at[(axis + 1) % 3] = i + u, at[(axis + 2) % 3] = j + v;
            return vertex(at);
          };
          const int a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          if (end == 0)
            box.triangles.insert(box.triangles.end(), {{a, c, b}, {a, d, c}});
          else
            box.triangles.insert(box.triangles.end(), {{a, b, c}, {a, c, d}});
        }
  return box;
}

TEST(Smooth, AConvexSolidShrinksAtEveryStep) {
  for (const Mesh& solid : {ball_mesh(2), ball_mesh(4), grid_box(5)}) {
    double volume = topology(solid).volume;
    for (int steps = 1; steps < 6; ++steps) {
      const double next = topology(smooth(solid, {.steps = steps})).volume;
      EXPECT_LT(next, volume);
      EXPECT_GT(next, 0);
      volume = next;
    }
  }
}

TEST_P(SmoothTest, TaubinKeepsTheVolumeAndEvensOut) {
  const auto roughness = [](const Mesh& mesh) {
    double squares = 0;
    const double radius = std::cbrt(topology(mesh).volume * 3 / 4 / std::numbers::pi);
    for (const Vec3& p : mesh.positions) squares += std::pow(p.norm() - radius, 2);
    return std::sqrt(squares / mesh.positions.size());
  };
  const Mesh mesh = shaken(ball_mesh(4), GetParam(), 0.01);
  const SmoothOptions options{.steps = 10, .method = Smoothing::taubin};
  const Mesh taubin = smooth(mesh, options), laplacian = smooth(mesh, {.steps = 10});
  const double volume = topology(mesh).volume;
  EXPECT_NEAR(topology(taubin).volume / volume, 1, 0.01);
  EXPECT_LT(topology(laplacian).volume / volume, 0.99);
  EXPECT_LT(roughness(taubin), 0.6 * roughness(mesh));
}

bool on_edge(const Vec3& p) {
  int ends = 0;
  for (const double x : p) ends += x == 0 || x == 1;
  return ends >= 2;
}

TEST(Smooth, EdgesSharperThanTheLevelStay) {
  const Mesh box = grid_box(6), moved = smooth(box, {.steps = 5, .level = 89});
  ASSERT_TRUE(topology(box).solid());
  for (std::size_t v = 0; v < box.positions.size(); ++v) {
    if (on_edge(box.positions[v])) {
      EXPECT_EQ(moved.positions[v], box.positions[v]);
    }
  }
  EXPECT_DOUBLE_EQ(topology(moved).volume, 1);
}

TEST(Smooth, TaubinKeepsEdgesSharperThanTheLevel) {
  const Mesh box = grid_box(6);
  EXPECT_DOUBLE_EQ(topology(smooth(box, {.steps = 5, .level = 89, .method = Smoothing::taubin})).volume, 1);
}

TEST(Smooth, EdgesAsSharpAsTheLevelAreSmoothed) {
  const Mesh box = grid_box(6), moved = smooth(box, {.steps = 1, .level = 90});
  EXPECT_EQ(moved, smooth(box, {.steps = 1}));
  for (std::size_t v = 0; v < box.positions.size(); ++v) {
    if (on_edge(box.positions[v])) {
      EXPECT_NE(moved.positions[v], box.positions[v]);
    }
  }
}

struct Guided {
  Mesh mesh;
  Guides guides;
};
Guided sharp_hull(const Shape& shape, int grid) {
  const ViewSet views = aligned(shape, kThreeViews, {.pixels = 300});
  const VoxelGrid hull = carve_silhouettes(views, {.grid = grid}).grid;
  const Crossings crossings = contour_crossings(views, hull);
  const Mesh mesh = marching_cubes(hull, crossings);
  Guides guides = vertex_guides(mesh, hull, crossings);
  Mesh sharp = sharpen(mesh, hull, guides);
  return {std::move(sharp), std::move(guides)};
}

TEST(Smooth, KeptBoxesAndStairsStayExact) {
  for (const Shape& shape : {box(), stairs(5)}) {
    const Guided hull = sharp_hull(shape, 50);
    const double volume = topology(hull.mesh).volume;
    for (const Smoothing method : {Smoothing::laplacian, Smoothing::taubin}) {
      const SmoothOptions kept{.steps = 5, .method = method, .keep = true};
      EXPECT_NEAR(topology(smooth(hull.mesh, kept, {}, hull.guides)).volume, volume, 1e-4) << shape.name;
    }
    EXPECT_LT(topology(smooth(hull.mesh, {.steps = 5, .keep = false}, {}, hull.guides)).volume, volume - 1e-3)
        << shape.name;
  }
}

TEST(Smooth, KeptVerticesSlideAlongTheirGuides) {
  for (const Shape& shape : all_shapes()) {
    const Guided hull = sharp_hull(shape, 40);
    const Mesh kept = smooth(hull.mesh, {.steps = 3, .keep = true}, {}, hull.guides);
    for (std::size_t v = 0; v < hull.guides.size(); ++v) {
      const Vec3 way = kept.positions[v] - hull.mesh.positions[v], axis = hull.guides[v].axis.cast<double>();
      const Guide::Kind kind = hull.guides[v].kind;
      const double off = kind == Guide::Kind::plane   ? std::abs(way.dot(axis))
                         : kind == Guide::Kind::line  ? way.cross(axis).norm()
                         : kind == Guide::Kind::fixed ? way.norm()
                                                      : 0;
      ASSERT_LT(off, 1e-6) << shape.name << " " << v;
    }
  }
}

TEST(Smooth, RefusesGuidesOfAnotherMesh) {
  EXPECT_THROW(smooth(tetrahedron_mesh(), {.keep = true}, {}, Guides(3)), std::invalid_argument);
  EXPECT_EQ(smooth(tetrahedron_mesh(), {.keep = true}), smooth(tetrahedron_mesh()));
}

TEST(Smooth, AVertexOfManyTrianglesCostsNoSquare) {
  constexpr int kSides = 100000;
  Mesh cone;
  for (int i = 0; i < kSides; ++i) {
    cone.positions.emplace_back(std::cos(i), 0, std::sin(i));
    cone.triangles.push_back({kSides, i, (i + 1) % kSides});
  }
  cone.positions.emplace_back(0, 1, 0);
  const Vec3 apex = smooth(cone, {.steps = 1}).positions.back();
  EXPECT_NEAR(apex.y(), 0, 1e-12);
}

TEST(Smooth, VerticesWithoutTrianglesStay) {
  Mesh mesh = tetrahedron_mesh();
  mesh.positions.emplace_back(5, 6, 7);
  EXPECT_EQ(smooth(mesh).positions.back(), Vec3(5, 6, 7));
}

TEST(Smooth, RefusesOptionsOutOfRangeAndStops) {
  EXPECT_THROW(smooth(tetrahedron_mesh(), {.steps = -1}), std::invalid_argument);
  EXPECT_THROW(smooth(tetrahedron_mesh(), {.level = 181}), std::invalid_argument);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(smooth(tetrahedron_mesh(), {}, {.stop = stop.get_token()}), Cancelled);
}

}  // namespace
}  // namespace carve
