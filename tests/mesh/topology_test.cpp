#include "carve/mesh/topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <sstream>

#include "carve/core/parallel.h"
#include "mesh/solids.h"

namespace carve {
namespace {

// Renumbers vertices, reorders triangles and turns their corners: the same surface.
Mesh shuffled(const Mesh& mesh, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<int> order(mesh.positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::shuffle(order.begin(), order.end(), random);
  Mesh result = mesh;
  for (std::size_t i = 0; i < order.size(); ++i) result.positions[order[i]] = mesh.positions[i];
  for (Triangle& t : result.triangles) {
    for (int& corner : t) corner = order[corner];
    std::rotate(t.begin(), t.begin() + random() % 3, t.end());
  }
  std::shuffle(result.triangles.begin(), result.triangles.end(), random);
  return result;
}

void expect_solid(const Mesh& mesh, int components, int genus) {
  const Topology found = topology(mesh);
  EXPECT_TRUE(found.solid()) << found;
  EXPECT_EQ(found.components, components);
  EXPECT_EQ(found.genus, genus);
  EXPECT_EQ(found.euler, 2 * (components - genus));
  EXPECT_EQ(2 * found.edges, 3 * found.triangles);
  EXPECT_EQ(found.unused_vertices, 0);
  EXPECT_EQ(found.degenerate_triangles, 0);
}

TEST(Topology, KnownSolids) {
  expect_solid(tetrahedron_mesh(), 1, 0);
  expect_solid(cube_mesh(), 1, 0);
  expect_solid(ball_mesh(3), 1, 0);
  expect_solid(torus_mesh(), 1, 1);
  expect_solid(torus_mesh(3, 3), 1, 1);
  expect_solid(together(torus_mesh(), cube_mesh()), 2, 1);
}

TEST(Topology, AreaAndVolumeOfTheCube) {
  const Topology found = topology(cube_mesh());
  EXPECT_EQ(found.area, 6);
  EXPECT_DOUBLE_EQ(found.volume, 1);
}

TEST(Topology, VolumeIsNegativeInsideOut) {
  Mesh cube = cube_mesh();
  for (Triangle& t : cube.triangles) std::swap(t[1], t[2]);
  const Topology found = topology(cube);
  EXPECT_TRUE(found.solid());
  EXPECT_DOUBLE_EQ(found.volume, -1);
}

TEST(Topology, VolumeFarFromTheOriginStaysExact) {
  Mesh cube = cube_mesh();
  for (Vec3& p : cube.positions) p += Vec3(1e9, -1e9, 1e9);
  EXPECT_DOUBLE_EQ(topology(cube).volume, 1);
}

TEST(Topology, TheBallsVolumeAndAreaConvergeFromBelow) {
  double last_volume = 0, last_area = 0;
  for (int times = 2; times < 7; ++times) {
    const Topology found = topology(ball_mesh(times));
    EXPECT_GT(found.volume, last_volume);
    EXPECT_GT(found.area, last_area);
    last_volume = found.volume, last_area = found.area;
  }
  EXPECT_NEAR(last_volume, 4 * std::numbers::pi / 3, 5e-3);
  EXPECT_NEAR(last_area, 4 * std::numbers::pi, 5e-3);
}

TEST(Topology, ATriangleMissingIsThreeBoundaryEdges) {
  Mesh mesh = ball_mesh(2);
  mesh.triangles.erase(mesh.triangles.begin() + 7);
  const Topology found = topology(mesh);
  EXPECT_EQ(found.boundary_edges, 3);
  EXPECT_TRUE(found.manifold());
  EXPECT_FALSE(found.closed());
  EXPECT_FALSE(found.solid());
  EXPECT_EQ(found.euler, 1);
}

TEST(Topology, ATriangleFlippedIsThreeMisorientedEdges) {
  Mesh mesh = torus_mesh();
  std::swap(mesh.triangles[5][0], mesh.triangles[5][1]);
  const Topology found = topology(mesh);
  EXPECT_EQ(found.misoriented_edges, 3);
  EXPECT_TRUE(found.closed() && found.manifold());
  EXPECT_FALSE(found.oriented());
  EXPECT_FALSE(found.solid());
}

TEST(Topology, TwoSolidsThatShareAVertexAreABowTie) {
  Mesh mesh = together(tetrahedron_mesh(), tetrahedron_mesh());
  for (Triangle& t : mesh.triangles) std::replace(t.begin(), t.end(), 4, 0);
  const Topology found = topology(mesh);
  EXPECT_EQ(found.nonmanifold_vertices, 1);
  EXPECT_EQ(found.nonmanifold_edges, 0);
  EXPECT_EQ(found.unused_vertices, 1);
  EXPECT_EQ(found.components, 1);
  EXPECT_TRUE(found.closed() && found.oriented());
  EXPECT_FALSE(found.solid());
}

TEST(Topology, TwoSolidsThatShareAnEdge) {
  Mesh mesh = together(tetrahedron_mesh(), tetrahedron_mesh());
  for (Triangle& t : mesh.triangles) {
    std::replace(t.begin(), t.end(), 4, 0);
    std::replace(t.begin(), t.end(), 5, 1);
  }
  const Topology found = topology(mesh);
  EXPECT_EQ(found.nonmanifold_edges, 1);
  EXPECT_EQ(found.nonmanifold_vertices, 2);
  EXPECT_EQ(found.edges, 11);
  EXPECT_TRUE(found.closed());
}

TEST(Topology, AnEdgeOfThreeTriangles) {
  const Mesh mesh{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0, -1, 0)},
                  {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}};
  const Topology found = topology(mesh);
  EXPECT_EQ(found.nonmanifold_edges, 1);
  EXPECT_EQ(found.boundary_edges, 6);
  EXPECT_EQ(found.nonmanifold_vertices, 2);
}

TEST(Topology, TwoTrianglesBackToBackAreNoSurface) {
  const Mesh mesh{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {{0, 1, 2}, {0, 2, 1}}};
  const Topology found = topology(mesh);
  EXPECT_EQ(found.nonmanifold_vertices, 3);
  EXPECT_FALSE(found.solid());
}

TEST(Topology, TheSameTriangleTwice) {
  const Topology found = topology({{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {{0, 1, 2}, {0, 1, 2}}});
  EXPECT_EQ(found.misoriented_edges, 3);
  EXPECT_FALSE(found.solid());
}

TEST(Topology, ARepeatedCornerIsDegenerateAndNotManifold) {
  Mesh mesh = tetrahedron_mesh();
  mesh.triangles.push_back({1, 1, 2});
  const Topology found = topology(mesh);
  EXPECT_EQ(found.degenerate_triangles, 1);
  EXPECT_GE(found.nonmanifold_edges, 1);
  EXPECT_FALSE(found.solid());
}

TEST(Topology, TrianglesWithoutAreaAreDegenerateAtAnyScaleAndPlace) {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    Mesh mesh = tetrahedron_mesh();
    mesh.positions[3] = Vec3(0.5, 0.5, 0);  // on an edge
    for (Vec3& p : mesh.positions) p *= scale;
    EXPECT_EQ(topology(mesh).degenerate_triangles, 1) << scale;
    EXPECT_TRUE(topology(mesh).solid()) << scale;
  }
  EXPECT_EQ(topology(torus_mesh(400, 400, 1, 1e-6)).degenerate_triangles, 0);
}

TEST(Topology, AConeOfManyTrianglesIsOneFan) {
  constexpr int kSides = 100000;  // an apex whose fan must not cost the square of its size
  Mesh mesh;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSides;
    mesh.positions.emplace_back(std::cos(angle), 0, -std::sin(angle));
    mesh.triangles.push_back({kSides, i, (i + 1) % kSides});
    mesh.triangles.push_back({kSides + 1, (i + 1) % kSides, i});
  }
  mesh.positions.emplace_back(0, 1, 0);
  mesh.positions.emplace_back(0, -1, 0);
  expect_solid(mesh, 1, 0);
}

TEST(Topology, AnEmptyMeshIsNotSolid) {
  EXPECT_FALSE(topology({}).solid());
  EXPECT_EQ(topology({}).euler, 0);
  EXPECT_EQ(topology({{Vec3(0, 0, 0)}, {}}).unused_vertices, 1);
}

TEST(Topology, RefusesWhatIsNoMesh) {
  Mesh mesh = tetrahedron_mesh();
  mesh.triangles[2][1] = 4;
  EXPECT_THROW(topology(mesh), std::invalid_argument);
  mesh.triangles[2][1] = -1;
  EXPECT_THROW(topology(mesh), std::invalid_argument);
  mesh = tetrahedron_mesh();
  mesh.positions[1].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(topology(mesh), std::invalid_argument);
  mesh.positions[1].y() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(topology(mesh), std::invalid_argument);
}

TEST(Topology, PrintsOneLineAField) {
  std::ostringstream text;
  text << topology(cube_mesh());
  EXPECT_NE(text.str().find("vertices             8\n"), std::string::npos);
  EXPECT_NE(text.str().find("solid                yes\n"), std::string::npos);
}

// Counts by definition, with maps: slow and plain.
struct Plain {
  std::int64_t edges = 0, boundary = 0, nonmanifold = 0, misoriented = 0, bad_vertices = 0;
  bool operator==(const Plain&) const = default;
};
std::ostream& operator<<(std::ostream& out, const Plain& p) {
  return out << p.edges << " edges, " << p.boundary << " boundary, " << p.nonmanifold << " nonmanifold, "
             << p.misoriented << " misoriented, " << p.bad_vertices << " bad vertices";
}

bool is_path_or_cycle(const std::vector<std::pair<int, int>>& link) {
  std::map<int, std::vector<int>> next;
  for (const auto& [a, b] : link) {
    next[a].push_back(b);
    next[b].push_back(a);
  }
  if (std::any_of(next.begin(), next.end(), [](const auto& n) { return n.second.size() > 2; })) return false;
  std::set<int> reached;
  std::vector<int> open{next.begin()->first};
  while (!open.empty()) {
    const int at = open.back();
    open.pop_back();
    if (reached.insert(at).second) open.insert(open.end(), next[at].begin(), next[at].end());
  }
  return reached.size() == next.size() && !(link.size() == 2 && next.size() == 2);
}

Plain count_plainly(const Mesh& mesh) {
  std::map<std::pair<int, int>, std::vector<bool>> edges;  // whether each triangle runs from low to high
  std::map<int, std::vector<std::pair<int, int>>> links;
  for (const Triangle& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) {
      const int a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
      edges[std::minmax(a, b)].push_back(a < b);
      links[a].emplace_back(b, c);
    }
  Plain result;
  result.edges = static_cast<std::int64_t>(edges.size());
  for (const auto& [ends, runs] : edges) {
    result.boundary += runs.size() == 1;
    result.nonmanifold += runs.size() > 2;
    result.misoriented += runs.size() == 2 && runs[0] == runs[1];
  }
  for (const auto& [vertex, link] : links) result.bad_vertices += !is_path_or_cycle(link);
  return result;
}

class TopologySeeds : public ::testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, TopologySeeds, ::testing::Range(0u, 20u));

TEST_P(TopologySeeds, NumberingAndOrderDoNotMatter) {
  const Mesh mesh = random_solid(GetParam());
  const Topology a = topology(mesh), b = topology(shuffled(mesh, GetParam()));
  EXPECT_TRUE(a.solid());
  EXPECT_TRUE(b.solid());
  EXPECT_EQ(a.genus, b.genus);
  EXPECT_EQ(a.components, b.components);
  EXPECT_EQ(a.edges, b.edges);
  EXPECT_NEAR(a.volume, b.volume, 1e-12 * a.area);
  EXPECT_NEAR(a.area, b.area, 1e-14 * a.area);
}

TEST_P(TopologySeeds, RandomTriangleSoupsAreCountedByDefinition) {
  std::mt19937 random(GetParam());
  for (int round = 0; round < 50; ++round) {
    const int vertices = 4 + static_cast<int>(random() % 8);
    Mesh mesh{std::vector<Vec3>(vertices, Vec3::Zero()), {}};
    while (mesh.triangles.size() < 2 + random() % 14) {
      const int a = static_cast<int>(random() % vertices), b = static_cast<int>(random() % vertices),
                c = static_cast<int>(random() % vertices);
      if (a != b && b != c && c != a) mesh.triangles.push_back({a, b, c});
    }
    const Topology found = topology(mesh);
    const Plain counted{found.edges, found.boundary_edges, found.nonmanifold_edges, found.misoriented_edges,
                        found.nonmanifold_vertices};
    EXPECT_EQ(counted, count_plainly(mesh));
  }
}

TEST_P(TopologySeeds, ThreadsDoNotChangeABit) {
  const Mesh mesh = shaken(ball_mesh(6), GetParam(), 0.01);
  set_thread_count(1);
  const Topology one = topology(mesh);
  set_thread_count(4);
  const Topology four = topology(mesh);
  set_thread_count(0);
  EXPECT_EQ(one.area, four.area);
  EXPECT_EQ(one.volume, four.volume);
  EXPECT_EQ(one.edges, four.edges);
}

}  // namespace
}  // namespace carve
