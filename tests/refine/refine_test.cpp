#include "carve/refine/refine.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "carve/core/parallel.h"
#include "carve/grid/voxel_grid.h"
#include "carve/mesh/self_intersections.h"
#include "carve/mesh/topology.h"
#include "carve/surface/marching_cubes.h"
#include "mesh/solids.h"

namespace carve {
namespace {

// Thin crossing plates of random places: nothing that smoothing or decimation would leave in peace.
Mesh plates(unsigned seed) {
  std::mt19937 random(seed);
  VoxelGrid grid({12, 12, 12}, Vec3::Zero(), 1.0 / 12);
  for (int plate = 0; plate < 4; ++plate) {
    const int axis = static_cast<int>(random() % 3), place = 1 + static_cast<int>(random() % 10);
    for (int i = 1; i < 11; ++i)
      for (int j = 1; j < 11; ++j) {
        int at[3];
        at[axis] = place, at[(axis + 1) % 3] = i, at[(axis + 2) % 3] = j;
        if (random() % 9) grid.set(at[0], at[1], at[2], true);
      }
  }
  return marching_cubes(grid);
}

class Plates : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, Plates, testing::Range(0u, 6u));

const std::vector<std::string> kAll = {"remesh", "smooth_shape", "angle_and_area", "tangential", "segment", "decimate"};

TEST_P(Plates, AreNeverWorseAfterAnyStage) {
  const Mesh mesh = plates(GetParam());
  const std::size_t meeting = self_intersections(mesh).size();
  for (const std::string& stage : kAll) {
    const RefinedMesh refined =
        refine(mesh, {.arm = {stage}, .faces = stage == "decimate" ? std::optional(300) : std::nullopt});
    EXPECT_TRUE(topology(refined.mesh).solid()) << stage;
    EXPECT_LE(self_intersections(refined.mesh).size(), meeting) << stage;
    ASSERT_EQ(refined.steps.size(), 1u);
    const RefinementStep& step = refined.steps[0];
    EXPECT_EQ(step.stage, stage);
    EXPECT_EQ(step.triangles, static_cast<std::int64_t>(refined.mesh.triangles.size()));
    EXPECT_EQ(step.self_intersections, static_cast<std::int64_t>(self_intersections(refined.mesh).size()));
    EXPECT_TRUE(step.kept || refined.mesh == mesh) << stage;
    EXPECT_TRUE(!step.why.empty() || (step.kept && step.put_back == 0)) << stage;
  }
}

TEST_P(Plates, AreDecimatedAsFarAsTheyStayAsTheyAre) {
  const Mesh mesh = plates(GetParam());
  const RefinedMesh less = refine(mesh, {.faces = static_cast<int>(mesh.triangles.size() / 6)});
  EXPECT_TRUE(less.steps[0].kept) << less.steps[0].why;
  EXPECT_LT(less.mesh.triangles.size(), mesh.triangles.size() / 2);
}

TEST(Refine, SomethingBreaksAndIsMended) {
  int put_back = 0, rolled_back = 0;
  for (unsigned seed = 0; seed < 4; ++seed) {
    const RefinedMesh flowed =
        refine(plates(seed), {.arm = {"smooth_shape"}, .stages = {.feature = 180, .shape_time = 0.01}});
    put_back += flowed.steps[0].put_back > 0;
    rolled_back += !flowed.steps[0].kept;
  }
  EXPECT_GT(put_back + rolled_back, 0);
}

TEST(Refine, WhatCannotBeMendedIsRolledBack) {
  // Two shells so near that long edges of one cut through the other.
  Mesh inner = shaken(ball_mesh(4), 1, 1e-3);
  for (Vec3& p : inner.positions) p *= 0.99;
  for (Triangle& t : inner.triangles) std::swap(t[0], t[1]);
  const Mesh shell = together(ball_mesh(4), inner);
  const RefinedMesh refined = refine(shell, {.arm = {"remesh"}, .stages = {.edge_length = 0.6}});
  EXPECT_FALSE(refined.steps[0].kept);
  EXPECT_THAT(refined.steps[0].why, testing::HasSubstr("meet"));
  EXPECT_EQ(refined.mesh, shell);
}

TEST(Refine, WrapsOnlyWhatMeetsItself) {
  const RefineOptions wrap{.arm = {"alpha_wrap"}, .stages = {.wrap_detail = 0.1}};
  EXPECT_EQ(refine(ball_mesh(), wrap).mesh, ball_mesh());
  Mesh other = cube_mesh();
  for (Vec3& p : other.positions) p += Vec3(0.5, 0.3, 0.2);
  const RefinedMesh wrapped = refine(together(cube_mesh(), other), wrap);
  EXPECT_EQ(wrapped.steps[0].self_intersections, 0);
  EXPECT_EQ(topology(wrapped.mesh).components, 1);
}

TEST(Refine, ThreadsDoNotChangeTheBytes) {
  std::vector<Mesh> results;
  for (const int threads : {1, 4}) {
    set_thread_count(threads);
    results.push_back(refine(plates(1), {.arm = kAll, .faces = 500}).mesh);
  }
  set_thread_count(0);
  EXPECT_EQ(results[0], results[1]);
}

TEST(Refine, NothingAskedForChangesNothing) { EXPECT_EQ(refine(ball_mesh()).mesh, ball_mesh()); }

TEST(Refine, BadInputIsRefused) {
  EXPECT_THROW(refine(ball_mesh(), {.arm = {"polish"}}), std::invalid_argument);
  EXPECT_THROW(refine(ball_mesh(), {.arm = {"decimate"}}), std::invalid_argument);
  EXPECT_THROW(refine(ball_mesh(), {.faces = 3}), std::invalid_argument);
  EXPECT_THROW(refine(ball_mesh(), {.arm = {"remesh"}, .stages = {.iterations = -1}}), std::invalid_argument);
  Mesh open = ball_mesh();
  open.triangles.pop_back();
  EXPECT_THROW(refine(open, {.arm = {"remesh"}}), std::invalid_argument);
}

}  // namespace
}  // namespace carve
