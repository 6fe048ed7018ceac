#include "carve/refine/stages.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "carve/core/parallel.h"
#include "carve/grid/voxel_grid.h"
#include "carve/mesh/self_intersections.h"
#include "carve/mesh/topology.h"
#include "carve/surface/marching_cubes.h"
#include "carve/surface/smooth.h"
#include "mesh/solids.h"
#include "shapes.h"

namespace carve {
namespace {

Mesh surface_of(const Shape& shape, int resolution = 24) {
  VoxelGrid grid = grid_over({-shape.size.x() / 2, 0, -shape.size.z() / 2},
                             {shape.size.x() / 2, shape.size.y(), shape.size.z() / 2}, resolution);
  for (int z = 0; z < grid.size().z(); ++z)
    for (int y = 0; y < grid.size().y(); ++y)
      for (int x = 0; x < grid.size().x(); ++x) grid.set(x, y, z, shape.inside(grid.centre(x, y, z)));
  return smooth(marching_cubes(grid));
}

// Largest over smallest edge, as the quartiles' ratio.
double spread_of_edges(const Mesh& mesh) {
  std::vector<double> lengths;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) lengths.push_back((mesh.positions[t[k]] - mesh.positions[t[(k + 1) % 3]]).norm());
  std::sort(lengths.begin(), lengths.end());
  return lengths[lengths.size() * 9 / 10] / lengths[lengths.size() / 10];
}

double mean_edge(const Mesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) sum += (mesh.positions[t[k]] - mesh.positions[t[(k + 1) % 3]]).norm();
  return sum / (3.0 * static_cast<double>(mesh.triangles.size()));
}

double roughness(const Mesh& mesh, double radius) {
  double sum = 0;
  for (const Vec3& p : mesh.positions) sum += std::pow(p.norm() - radius, 2);
  return std::sqrt(sum / static_cast<double>(mesh.positions.size()));
}

using StageRun = Mesh (*)(const Mesh&, const StageOptions&);
constexpr StageRun kMovers[] = {smooth_shape, angle_and_area, tangential, segment};

TEST(Stages, KeepTheTopologyOfEveryShape) {
  for (const Shape& shape : all_shapes()) {
    const Mesh mesh = surface_of(shape);
    const Topology before = topology(mesh);
    const auto expect_kept = [&](const Mesh& refined, const char* stage) {
      const Topology after = topology(refined);
      EXPECT_TRUE(after.solid()) << shape.name << " " << stage;
      EXPECT_EQ(after.genus, before.genus) << shape.name << " " << stage;
      EXPECT_EQ(after.components, before.components) << shape.name << " " << stage;
      EXPECT_NEAR(after.volume, before.volume, 0.03 * before.volume) << shape.name << " " << stage;
    };
    expect_kept(remesh(mesh), "remesh");
    expect_kept(decimate(mesh, 400), "decimate");
    for (const StageRun run : kMovers) {
      const Mesh moved = run(mesh, {});
      EXPECT_EQ(moved.triangles, mesh.triangles);
      expect_kept(moved, "mover");
    }
  }
}

TEST(Stages, ThreadsDoNotChangeTheBytes) {
  const Mesh mesh = surface_of(walled_stairs());
  std::vector<Mesh> results[2];
  for (const int threads : {1, 4}) {
    set_thread_count(threads);
    auto& all = results[threads > 1];
    for (const StageRun run : kMovers) all.push_back(run(mesh, {}));
    all.push_back(remesh(mesh));
    all.push_back(decimate(mesh, 300));
    all.push_back(alpha_wrap(mesh, {.wrap_detail = 0.1}));
  }
  set_thread_count(0);
  EXPECT_EQ(results[0], results[1]);
}

TEST(Stages, NoIterationsAreTheIdentity) {
  const Mesh mesh = surface_of(ball(), 12);
  for (const StageRun run : {StageRun(remesh), StageRun(smooth_shape), StageRun(angle_and_area), StageRun(tangential)})
    EXPECT_EQ(run(mesh, {.iterations = 0}), mesh);
}

TEST(Remesh, MakesEdgesOfOneLength) {
  const Mesh mesh = torus_mesh(80, 20);
  const Mesh even = remesh(mesh, {.edge_length = 0.5 * mean_edge(mesh)});
  EXPECT_NEAR(mean_edge(even) / mean_edge(mesh), 0.5, 0.05);
  EXPECT_LT(spread_of_edges(even), 0.8 * spread_of_edges(mesh));
}

TEST(Remesh, KeepsFeatures) {
  const Mesh cube = cube_mesh();
  const Topology fine = topology(remesh(cube, {.edge_length = 0.07}));
  EXPECT_GT(fine.triangles, 1000);
  EXPECT_NEAR(fine.volume, topology(cube).volume, 1e-9);
  EXPECT_NEAR(fine.area, topology(cube).area, 1e-9);
}

class NoisyBall : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, NoisyBall, testing::Range(0u, 4u));

TEST_P(NoisyBall, IsSmootherAndAsLargeAfterMeanCurvatureFlow) {
  const Mesh noisy = shaken(ball_mesh(4), GetParam(), 0.02);
  const double radius = ball_mesh(4).positions[0].norm();
  const Mesh flowed = smooth_shape(noisy, {.feature = 180});
  EXPECT_LT(roughness(flowed, radius), 0.5 * roughness(noisy, radius));
  EXPECT_NEAR(topology(flowed).volume, topology(noisy).volume, 1e-6 * topology(noisy).volume);
}

TEST_P(NoisyBall, KeepsItsVolumeBesideFeatures) {
  Mesh half = shaken(ball_mesh(4), GetParam(), 0.01);  // with a sharp rim
  for (Vec3& p : half.positions) p.y() = std::max(p.y(), 0.0);
  const Mesh flowed = smooth_shape(half, {.feature = 60});
  EXPECT_NE(flowed, half);
  EXPECT_NEAR(topology(flowed).volume, topology(half).volume, 1e-6 * topology(half).volume);
}

TEST_P(NoisyBall, HasEvenerTrianglesAfterRelaxation) {
  Mesh uneven = shaken(ball_mesh(4), GetParam(), 0.02);
  for (Vec3& p : uneven.positions) p.normalize();
  for (const StageRun run : {StageRun(tangential), StageRun(angle_and_area)}) {
    const Mesh even = run(uneven, {});
    EXPECT_LT(spread_of_edges(even), spread_of_edges(uneven));
    EXPECT_LT(roughness(even, 1), 0.01) << "it stays on the ball";
  }
}

TEST_P(NoisyBall, IsDecimatedToTheNumberOfTriangles) {
  const Mesh mesh = shaken(ball_mesh(4), GetParam(), 0.01);
  for (const int faces : {1000, 400, 101}) {
    const Topology less = topology(decimate(mesh, faces));
    EXPECT_LE(less.triangles, faces);
    EXPECT_GE(less.triangles, faces - 2);
    EXPECT_EQ(less.genus, 0);
  }
  EXPECT_EQ(decimate(mesh, 1000000), mesh);
}

TEST_P(NoisyBall, RoughBoxesBecomeFlatParts) {
  const Mesh flat = remesh(cube_mesh(), {.edge_length = 0.08});
  const Mesh rough = shaken(flat, GetParam(), 0.002);
  const Mesh parts = segment(rough, {.parts = 12, .flatness = 0.01});
  double before = 0, after = 0;
  for (std::size_t v = 0; v < flat.positions.size(); ++v) {
    const auto off = [&](const Mesh& mesh) {
      return std::abs((mesh.positions[v] - Vec3::Constant(0.5)).cwiseAbs().maxCoeff() - 0.5);
    };
    before += off(rough);
    after += off(parts);
  }
  EXPECT_LT(after, 0.5 * before);
}

TEST(AlphaWrap, MakesASolidOfWhateverItIsGiven) {
  Mesh crossing = cube_mesh(), other = cube_mesh();
  for (Vec3& p : other.positions) p += Vec3(0.5, 0.25, 0.25);
  crossing = together(crossing, other);
  crossing.triangles.pop_back();  // and a hole
  const Mesh wrap = alpha_wrap(crossing, {.wrap_detail = 0.2});
  EXPECT_TRUE(topology(wrap).solid());
  EXPECT_TRUE(self_intersections(wrap).empty());
  const double of_union = 2 - 0.5 * 0.75 * 0.75;
  EXPECT_GT(topology(wrap).volume, 0.9 * of_union);
  EXPECT_LT(topology(wrap).volume, 1.2 * of_union);
}

}  // namespace
}  // namespace carve
