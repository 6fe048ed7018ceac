#include "carve/mesh/self_intersections.h"

#include <gtest/gtest.h>

#include "carve/core/parallel.h"
#include "eval/meshes.h"

namespace carve {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

class SelfIntersections : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, SelfIntersections, testing::Range(0u, 8u));

TEST_P(SelfIntersections, AreNoneInAnEmbeddedSurface) {
  EXPECT_EQ(self_intersections(potato(20, GetParam())), Pairs{});
  const auto motion = random_motion(GetParam());
  EXPECT_EQ(self_intersections(mapped(cube(), [&](const Vec3& p) { return Vec3(motion * p); })), Pairs{});
}

TEST_P(SelfIntersections, AreFoundWhereShellsCross) {
  const Mesh a = potato(12, GetParam());
  const Mesh both = joined(a, mapped(a, [](const Vec3& p) { return Vec3(p + Vec3(0.7, 0.1, 0)); }));
  const Pairs pairs = self_intersections(both);
  EXPECT_GT(pairs.size(), 10u);
  for (const auto& [i, j] : pairs) {
    EXPECT_LT(i, static_cast<int>(a.triangles.size()));
    EXPECT_GE(j, static_cast<int>(a.triangles.size()));
  }
  set_thread_count(1);
  EXPECT_EQ(pairs, self_intersections(both));
  set_thread_count(0);
}

TEST(SelfIntersections, ByOneSharedCornerEdgeOrTriangle) {
  const std::vector<Vec3> p = {{0, 0, 0}, {1, 0, 0},     {0, 1, 0},      {0.5, 0.5, 0},
                               {1, 1, 0}, {0.2, 0.2, 1}, {0.2, 0.2, -1}, {-1, -1, 0}};
  EXPECT_EQ(self_intersections({p, {{0, 1, 2}, {1, 4, 2}}}), Pairs{});          // flat neighbours
  EXPECT_EQ(self_intersections({p, {{0, 1, 2}, {1, 0, 3}}}), (Pairs{{0, 1}}));  // folded over their side
  EXPECT_EQ(self_intersections({p, {{0, 1, 2}, {0, 5, 6}}}), (Pairs{{0, 1}}));  // through, from a shared corner
  EXPECT_EQ(self_intersections({p, {{0, 1, 2}, {0, 6, 7}}}), Pairs{});          // only the corner
  EXPECT_EQ(self_intersections({p, {{0, 1, 2}, {2, 1, 0}}}), (Pairs{{0, 1}}));  // back to back
  EXPECT_EQ(self_intersections({p, {{0, 1, 2}, {3, 4, 5}}}), (Pairs{{0, 1}}));  // a corner touches a side
  EXPECT_EQ(self_intersections({p, {{0, 1, 2}, {5, 6, 4}, {0, 0, 5}}}), (Pairs{{0, 1}}));  // no area: left out
}

}  // namespace
}  // namespace carve
