#include "models/inside.h"

#include <gtest/gtest.h>

#include <random>

#include "models/primitives.h"
#include "models/procedural.h"
#include "models/shells.h"
#include "models/winding.h"

namespace carve {
namespace {

constexpr double kExact = std::numeric_limits<double>::infinity();

// The same model with some of its triangles missing.
Model holed(const Model& model, const std::function<bool(const Triangle&)>& gone) {
  Model result = model;
  std::erase_if(result.mesh.triangles, gone);
  return result;
}

class OccupancyTest : public testing::TestWithParam<ProceduralModel> {};
INSTANTIATE_TEST_SUITE_P(All, OccupancyTest, testing::ValuesIn(procedural_models().begin(), procedural_models().end()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST_P(OccupancyTest, IsWhereAShellWindsAroundTheVoxel) {
  const Model model = GetParam().make();
  const VoxelGrid grid = occupancy(model, grid_of(model, 64));
  std::vector<WindingNumber> exact;
  for (const Mesh& shell : shells(model.mesh)) exact.emplace_back(shell, kExact);
  std::mt19937 random(1);
  for (int i = 0; i < 25; ++i) {
    const int x = static_cast<int>(random() % grid.size().x()), y = static_cast<int>(random() % grid.size().y()),
              z = static_cast<int>(random() % grid.size().z());
    double most = 0;
    for (const WindingNumber& winding : exact) most = std::max(most, winding(grid.centre(x, y, z)));
    if (std::abs(most - 0.5) < 1e-6) continue;  // on the surface
    EXPECT_EQ(grid(x, y, z), most > 0.5) << x << ' ' << y << ' ' << z;
  }
}

TEST(Occupancy, OfABallHasItsVolume) {
  const Model model = sphere();
  const double volume = 4 * std::acos(-1.0) / 3 / 8;
  EXPECT_NEAR(occupancy(model, grid_of(model, 64)).volume() / volume, 1, 0.004);
  EXPECT_NEAR(occupancy(model, grid_of(model, 200)).volume() / volume, 1, 0.001);
}

TEST(Occupancy, OfABoxIsEveryVoxelOfItsGrid) {
  Model model;
  add(model, "m", {}, box({-0.5, 0, -0.25}, {0.5, 0.75, 0.25}));
  const VoxelGrid grid = occupancy(model, grid_of(model, 32));
  EXPECT_EQ(grid.size(), Vec3i(32, 24, 16));
  EXPECT_EQ(grid.count(), 32 * 24 * 16);
}

TEST(Occupancy, DoesNotDependOnTheShellsOrientation) {
  Model model = robot();
  const VoxelGrid grid = occupancy(model, grid_of(model, 48));
  for (Triangle& t : model.mesh.triangles) std::swap(t[0], t[1]);
  EXPECT_EQ(occupancy(model, grid), grid);
}

TEST(Occupancy, SplitCornersAreJoined) {
  const Model model = couch();
  Model split;
  for (const Triangle& t : model.mesh.triangles) {
    for (const int k : t) split.mesh.positions.push_back(model.mesh.positions[k]);
    const int n = static_cast<int>(split.mesh.positions.size());
    split.mesh.triangles.push_back({n - 3, n - 2, n - 1});
  }
  const VoxelGrid grid = grid_of(model, 48);
  EXPECT_EQ(occupancy(split, grid), occupancy(model, grid));
}

TEST(Occupancy, ACavityIsFilled) {
  Model model;
  add(model, "m", {}, ellipsoid({0, 0, 0}, {0.5, 0.5, 0.5}));
  const VoxelGrid full = occupancy(model, grid_of(model, 40));
  Mesh inner = ellipsoid({0, 0, 0}, {0.3, 0.3, 0.3});
  for (Triangle& t : inner.triangles) std::swap(t[0], t[1]);
  add(model, "m", {}, inner);
  EXPECT_EQ(occupancy(model, full), full);
}

class OpenOccupancyTest : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, OpenOccupancyTest, testing::Range(0u, 3u));

TEST_P(OpenOccupancyTest, SurvivesMissingTriangles) {
  for (const char* name : {"robot", "sphere", "axe"}) {
    const Model model = procedural_model(name);
    std::mt19937 random(GetParam());
    const VoxelGrid grid = occupancy(model, grid_of(model, 40));
    const Model open = holed(model, [&](const Triangle&) { return random() % 33 == 0; });
    EXPECT_GT(intersection_over_union(occupancy(open, grid), grid), 0.99) << name;
  }
}

TEST(Occupancy, ABallWithoutItsFootStaysABall) {
  const Model model = sphere();
  const Model open = holed(model, [&](const Triangle& t) { return model.mesh.positions[t[0]].y() < 0.03; });
  const VoxelGrid grid = occupancy(model, grid_of(model, 40));
  EXPECT_GT(intersection_over_union(occupancy(open, grid), grid), 0.995);
}

TEST(WindingNumber, ApproximatesTheSumOfSolidAngles) {
  const Mesh mesh = robot().mesh;
  const WindingNumber fast(mesh), exact(mesh, kExact);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-0.6, 0.6);
  double worst = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec3 p(unit(random), unit(random) + 0.5, unit(random));
    worst = std::max(worst, std::abs(fast(p) - exact(p)));
  }
  EXPECT_LT(worst, 0.04);
  EXPECT_NEAR(exact({0, 5, 0}), 0, 1e-12);
}

}  // namespace
}  // namespace carve
