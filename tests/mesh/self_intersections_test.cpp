#include "carve/mesh/self_intersections.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "carve/core/as_floats.h"
#include "carve/core/parallel.h"
#include "eval/meshes.h"
#include "mesh/solids.h"

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

/// What every two triangles say that stand alone, where nothing is known of what lies around them.
Pairs of_every_two(const Mesh& mesh) {
  Pairs pairs;
  for (int i = 0; i < static_cast<int>(mesh.triangles.size()); ++i)
    for (int j = i + 1; j < static_cast<int>(mesh.triangles.size()); ++j) {
      const Mesh two{mesh.positions, {mesh.triangles[i], mesh.triangles[j]}};
      if (!self_intersections(two).empty()) pairs.emplace_back(i, j);
    }
  return pairs;
}

TEST_P(SelfIntersections, AreThoseOfEveryTwoTriangles) {
  const unsigned seed = GetParam();
  const Mesh ball = ball_mesh(2);
  for (const Mesh& whole :
       {shaken(ball, seed, 0.4), shaken(torus_mesh(16, 8), seed, 0.15),
        together(ball, mapped(ball, [&](const Vec3& p) { return Vec3(p + Vec3(0.002 * (1 << seed), 0.01, 0)); })),
        together(grid_box(3), shaken(grid_box(3), seed, seed % 2 ? 0.3 : 0))}) {
    const Pairs pairs = of_every_two(whole);
    EXPECT_GT(pairs.size(), 3u);
    EXPECT_EQ(self_intersections(whole), pairs);
    Mesh open = whole;  // borders, and vertices without triangles
    open.triangles.resize(open.triangles.size() / 2);
    EXPECT_EQ(self_intersections(open), of_every_two(open));
  }
}

TEST_P(SelfIntersections, OfMovedVerticesAreThoseOfTheirTriangles) {
  const Mesh mesh = shaken(torus_mesh(24, 12), GetParam(), 0.06);
  std::mt19937 random(GetParam());
  for (const unsigned one_of : {2, 40}) {
    std::vector<std::uint8_t> moved(mesh.positions.size());
    for (std::uint8_t& m : moved) m = random() % one_of == 0;
    Pairs expected;
    const auto has_moved = [&](int t) {
      return std::ranges::any_of(mesh.triangles[t], [&](int v) { return moved[v] != 0; });
    };
    for (const auto& [i, j] : self_intersections(mesh))
      if (has_moved(i) || has_moved(j)) expected.emplace_back(i, j);
    EXPECT_FALSE(expected.empty());
    EXPECT_EQ(self_intersections(mesh, vertex_triangles(mesh), moved), expected);
  }
}

TEST_P(SelfIntersections, OfVerticesThatMovedSinceTheGridWasMadeAreThoseOfTheirTriangles) {
  const Mesh from = torus_mesh(24, 12), to = shaken(from, GetParam(), 0.2);
  const TriangleGrid grid(to, from.positions);
  std::mt19937 random(GetParam());
  Mesh mesh = to;
  std::size_t found = 0;
  for (int round = 0; round < 4; ++round) {  // vertices go back, half the way or all of it
    std::vector<std::uint8_t> moved(mesh.positions.size());
    std::vector<int> vertices;
    for (int v = 0; v < static_cast<int>(moved.size()); ++v) {
      if (random() % 10 != 0) continue;
      mesh.positions[v] = random() % 2 ? from.positions[v] : Vec3((mesh.positions[v] + from.positions[v]) / 2);
      moved[v] = 1;
      vertices.push_back(v);
    }
    const VertexTriangles around = vertex_triangles(mesh);
    for (const bool as_floats : {false, true}) {
      const Pairs pairs = self_intersections(mesh, around, grid, vertices, as_floats);
      EXPECT_EQ(pairs, self_intersections(mesh, around, moved, as_floats));
      found += pairs.size();
    }
  }
  EXPECT_GT(found, 0u);
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

TEST(SelfIntersections, OfTrianglesThatFoldOnceRoundedToFloatsAreFoundIfAskedFor) {
  const double x = 0.20512268133461475;  // the first corner lies off the others' plane by less than a float can say
  const Mesh mesh{{{x + 6e-17, 0.597578125, -0.2144015221},
                   {x, 0.5975379774, -0.2145832290},
                   {x, 0.5988335503, -0.2080129295},
                   {x, 0.597578125, -0.2038520515}},
                  {{0, 1, 2}, {0, 2, 3}}};
  ASSERT_NE(mesh.positions[0].x(), x);
  const VertexTriangles around = vertex_triangles(mesh);
  EXPECT_EQ(self_intersections(mesh), Pairs{});
  EXPECT_EQ(self_intersections(mesh, around, {}, true), (Pairs{{0, 1}}));
  Mesh written = mesh;
  for (Vec3& p : written.positions) p = as_floats(p);
  EXPECT_EQ(written.positions[0].x(), written.positions[1].x());
  EXPECT_EQ(self_intersections(written), (Pairs{{0, 1}}));
}

TEST(SelfIntersections, OfOnePointAreContacts) {
  const std::vector<Vec3> p = {{0, 0, 0},  {1, 0, 0},       {0, 1, 0},         {0.25, 0.25, 0}, {0.25, 0.25, 1},
                               {1, 1, 1},  {0.5, -0.25, 0}, {0.5, 0.25, 0},    {0.5, 0, 1},     {0.5, -1, 1},
                               {-1, 0, 0}, {0.25, 0.25, 2}, {0.25, 0.25, -0.5}};
  const auto are_contacts = [&](const Triangle& a, const Triangle& b) {
    const Mesh two{p, {a, b}};
    const Pairs meeting = self_intersections(two);
    EXPECT_EQ(meeting.size(), 1u);
    return contacts(two, meeting) == meeting;
  };
  EXPECT_TRUE(are_contacts({0, 1, 2}, {3, 4, 5}));    // a corner in a triangle
  EXPECT_FALSE(are_contacts({0, 1, 2}, {12, 4, 5}));  // through it
  EXPECT_FALSE(are_contacts({0, 1, 2}, {6, 7, 8}));   // a side in its plane
  EXPECT_FALSE(are_contacts({0, 1, 2}, {0, 7, 8}));   // from a common corner
}

}  // namespace
}  // namespace carve
