#include "carve/surface/smooth.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "carve/carving/carve_silhouettes.h"
#include "carve/core/as_floats.h"
#include "carve/core/error.h"
#include "carve/core/parallel.h"
#include "carve/mesh/adjacency.h"
#include "carve/mesh/self_intersections.h"
#include "carve/mesh/topology.h"
#include "carve/surface/marching_cubes.h"
#include "carve/surface/sharpen.h"
#include "mesh/solids.h"
#include "models/procedural.h"
#include "shapes.h"
#include "synthesize/synthesize.h"

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
Guided sharp_hull(const ViewSet& views, int grid) {
  const VoxelGrid hull = carve_silhouettes(views, {.grid = grid}).grid;
  const Crossings crossings = contour_crossings(views, hull);
  const Mesh mesh = marching_cubes(hull, crossings);
  Guides guides = vertex_guides(mesh, hull, crossings);
  Mesh sharp = sharpen(mesh, hull, guides);
  return {std::move(sharp), std::move(guides)};
}

Guided sharp_hull(const Shape& shape, int grid) {
  return sharp_hull(aligned(shape, kThreeViews, {.pixels = 300}), grid);
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

/// \return whether it did without mending
bool expect_no_passing_through_itself(const Guided& hull, const std::string& what) {
  const Mesh torn = smooth(hull.mesh, {.mend = false}, {}, hull.guides);
  const std::size_t meeting = self_intersections(torn, vertex_triangles(torn), {}, true).size();
  const Mesh mended = smooth(hull.mesh, {}, {}, hull.guides);
  EXPECT_EQ(self_intersections(mended).size(), 0u) << what << ", " << meeting << " if not mended";
  Mesh written = mended;
  for (Vec3& p : written.positions) p = as_floats(p);
  EXPECT_EQ(self_intersections(written).size(), 0u) << what;
  EXPECT_EQ(topology(written).degenerate_triangles, 0) << what;
  std::size_t moved = 0;
  for (std::size_t v = 0; v < torn.positions.size(); ++v)
    moved += !mended.positions[v].isApprox(torn.positions[v], 1e-9);
  EXPECT_LE(moved, 24 * meeting) << what;
  return meeting > 0;
}

TEST(Smooth, RandomSilhouettesDoNotPassThroughThemselves) {
  int solids = 0, torn = 0;
  for (unsigned seed = 0; solids < 300; ++seed) {
    ASSERT_LT(seed, 1000u);
    const Vec3i size(6 + static_cast<int>(seed % 9), 6 + static_cast<int>(seed % 7), 6 + static_cast<int>(seed % 5));
    try {
      const Guided hull = sharp_hull(views_of_masks(random_masks(size, seed)), 8 + static_cast<int>(seed % 17));
      torn += expect_no_passing_through_itself(hull, std::to_string(seed));
      ++solids;
    } catch (const NoResult&) {
    }
  }
  EXPECT_GT(torn, 50);
}

TEST(Smooth, ModelsDoNotPassThroughThemselves) {
  int torn = 0;
  for (const ProceduralModel& model : procedural_models()) {
    std::map<View, Drawing> drawings;
    for (auto& [view, picture] : synthesize(model.make(), {.size = 256}))
      drawings.emplace(view, understand_drawing(std::move(picture)));
    torn += expect_no_passing_through_itself(sharp_hull(align(std::move(drawings)), 64), model.name);
  }
  EXPECT_GT(torn, 3);
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
  const Vec3 apex = smooth(cone, {.steps = 1, .mend = false}).positions.back();
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
