#include "carve/mesh/mesh_io.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <clocale>
#include <locale>

#include "carve/core/error.h"
#include "carve/core/file.h"
#include "carve/mesh/ply.h"
#include "carve/mesh/topology.h"
#include "mesh/solids.h"
#include "temporary_folder.h"

namespace carve {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::ThrowsMessage;

// Positions as floats hold them.
Mesh as_floats(Mesh mesh) {
  for (Vec3& p : mesh.positions)
    for (double& x : p) {
      const volatile float rounded = static_cast<float>(x);  // g++ 12 leaves the rounding out where it vectorises
      x = rounded;
    }
  return mesh;
}

// The triangles' corners, for formats that do not keep the numbering.
std::vector<Vec3> corners(const Mesh& mesh) {
  std::vector<Vec3> all;
  for (const Triangle& t : mesh.triangles)
    for (const int i : t) all.push_back(mesh.positions[i]);
  return all;
}

template <class T>
T number_at(const std::string& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

class EveryFormat : public ::testing::TestWithParam<std::tuple<const char*, unsigned>> {
 protected:
  std::string ending() const { return std::get<0>(GetParam()); }
  unsigned seed() const { return std::get<1>(GetParam()); }
  std::filesystem::path path(const std::string& name = "mesh") const { return folder_ / (name + "." + ending()); }

 private:
  TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Seeds, EveryFormat,
                         ::testing::Combine(::testing::Values("ply", "obj", "off", "stl", "glb"),
                                            ::testing::Range(0u, 6u)));

TEST_P(EveryFormat, ReadsBackWhatWasWritten) {
  const Mesh mesh = random_solid(seed());
  write_mesh(path(), mesh);
  const Mesh read = read_mesh(path());
  if (ending() == "stl")
    EXPECT_EQ(corners(read), corners(as_floats(mesh)));
  else
    EXPECT_EQ(read, ending() == "glb" ? as_floats(mesh) : mesh);
  EXPECT_TRUE(topology(read).solid());
}

TEST_P(EveryFormat, TheSameMeshGivesTheSameBytes) {
  write_mesh(path("a"), random_solid(seed()));
  write_mesh(path("b"), random_solid(seed()));
  EXPECT_EQ(read_file(path("a")), read_file(path("b")));
}

TEST_P(EveryFormat, ReadingAndWritingAgainChangesNothing) {
  write_mesh(path("a"), as_floats(random_solid(seed())));
  write_mesh(path("b"), read_mesh(path("a")));
  EXPECT_EQ(read_file(path("a")), read_file(path("b")));
}

class German : public std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST_P(EveryFormat, TheLocaleChangesNothing) {
  const Mesh mesh = random_solid(seed());
  write_mesh(path("a"), mesh);
  const Mesh read = read_mesh(path("a"));
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new German));
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "de_DE"})
    if (std::setlocale(LC_ALL, name)) break;
  write_mesh(path("b"), mesh);
  const Mesh read_again = read_mesh(path("a"));
  std::locale::global(before);
  std::setlocale(LC_ALL, "C");
  EXPECT_EQ(read_file(path("a")), read_file(path("b")));
  EXPECT_EQ(read_again, read);
}

TEST_P(EveryFormat, ExtremeCoordinatesSurvive) {
  Mesh mesh = ball_mesh(1);
  const double scale = ending() == "stl" || ending() == "glb" ? 1e30 : 1e300;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) mesh.positions[i] *= i % 2 ? scale : 1 / scale;
  write_mesh(path(), mesh, {.strict = false});
  const Mesh expected = ending() == "stl" || ending() == "glb" ? as_floats(mesh) : mesh;
  EXPECT_EQ(corners(read_mesh(path())), corners(expected));
}

TEST_P(EveryFormat, AMeshThatIsNotSolidIsRefusedUnlessAllowed) {
  Mesh mesh = random_solid(seed());
  mesh.triangles.pop_back();
  EXPECT_THAT([&] { write_mesh(path(), mesh); },
              ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr(path().string()), HasSubstr("3 boundary edges"))));
  EXPECT_FALSE(std::filesystem::exists(path()));
  write_mesh(path(), mesh, {.strict = false});
  EXPECT_EQ(read_mesh(path()).triangles.size(), mesh.triangles.size());
}

TEST_P(EveryFormat, IndicesAndCoordinatesAreCheckedEvenIfNotStrict) {
  Mesh mesh = random_solid(seed());
  mesh.triangles[1][2] = static_cast<int>(mesh.positions.size());
  EXPECT_THAT([&] { write_mesh(path(), mesh, {.strict = false}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("mesh.triangles[1]")));
  mesh = random_solid(seed());
  mesh.positions[2].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT([&] { write_mesh(path(), mesh, {.strict = false}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("mesh.positions[2]")));
}

TEST(WriteMesh, TheMessageCountsEveryFault) {
  const TemporaryFolder folder;
  Mesh mesh = together(tetrahedron_mesh(), tetrahedron_mesh());
  for (Triangle& t : mesh.triangles) std::replace(t.begin(), t.end(), 4, 0);
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  mesh.triangles.pop_back();
  EXPECT_THAT([&] { write_mesh(folder / "a.obj", mesh); },
              ThrowsMessage<std::invalid_argument>(
                  HasSubstr("got 3 boundary edges, 3 misoriented edges, 1 nonmanifold vertex")));
  EXPECT_THAT([&] { write_mesh(folder / "a.obj", {}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("got no triangles")));
}

TEST(WriteMesh, UnknownEndingsAreRefused) {
  const TemporaryFolder folder;
  EXPECT_THAT([&] { write_mesh(folder / "a.xyz", cube_mesh()); },
              ThrowsMessage<std::invalid_argument>(HasSubstr(".ply, .obj, .off, .stl, .glb, got '.xyz'")));
  EXPECT_THAT([&] { read_mesh(folder / "a"); }, ThrowsMessage<IoError>(HasSubstr("got ''")));
  write_mesh(folder / "a.PLY", cube_mesh());
  EXPECT_EQ(read_mesh(folder / "a.PLY"), cube_mesh());
}

TEST(WriteMesh, FloatsThatWouldOverflowAreRefused) {
  const TemporaryFolder folder;
  Mesh mesh = cube_mesh();
  mesh.positions[7] *= 1e39;
  for (const char* name : {"a.stl", "a.glb"}) EXPECT_THROW(write_mesh(folder / name, mesh), std::invalid_argument);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(WriteObj, SaysItsUnitAndUsesTheShortestNumbers) {
  const TemporaryFolder folder;
  Mesh mesh = tetrahedron_mesh();
  mesh.positions[1].x() = 0.1;
  write_mesh(folder / "a.obj", mesh);
  EXPECT_THAT(read_file(folder / "a.obj"),
              AllOf(HasSubstr("unit"), HasSubstr("\nv 0.1 0 0\n"), HasSubstr("\nf 1 3 2\n")));
}

TEST(WriteStl, TurnsUpToZAndHasOutwardUnitNormals) {
  const TemporaryFolder folder;
  Mesh box = cube_mesh();
  for (Vec3& p : box.positions) p = Vec3(p.x(), 3 * p.y(), 2 * p.z());
  write_mesh(folder / "a.stl", box);
  const std::string bytes = read_file(folder / "a.stl");
  ASSERT_EQ(bytes.size(), 84 + 50 * box.triangles.size());
  EXPECT_THAT(bytes, Not(::testing::StartsWith("solid")));
  float highest = 0;
  for (std::size_t facet = 0; facet < box.triangles.size(); ++facet) {
    const std::size_t at = 84 + 50 * facet;
    const auto vector = [&](std::size_t i) {
      return Eigen::Vector3f(number_at<float>(bytes, at + 12 * i), number_at<float>(bytes, at + 12 * i + 4),
                             number_at<float>(bytes, at + 12 * i + 8));
    };
    const Eigen::Vector3f normal = vector(0), middle = (vector(1) + vector(2) + vector(3)) / 3;
    EXPECT_NEAR(normal.norm(), 1, 1e-6);
    EXPECT_GT(normal.dot(middle - Eigen::Vector3f(0.5f, -1.0f, 1.5f)), 0);
    highest = std::max({highest, vector(1).z(), vector(2).z(), vector(3).z()});
  }
  EXPECT_EQ(highest, 3);
}

TEST(WriteStl, FacetsThatCollapseAsFloatsAreLeftOutAndTheRestIsClosed) {
  const TemporaryFolder folder;
  Mesh mesh = ball_mesh(2);
  for (Vec3& p : mesh.positions) p += Vec3(3, 3, 3);
  const Triangle t = mesh.triangles[0];
  mesh.positions[t[1]] = mesh.positions[t[0]] + Vec3(1e-12, 1e-12, -1e-12);  // apart as doubles, not as floats
  ASSERT_TRUE(topology(mesh).solid());
  write_mesh(folder / "a.stl", mesh);
  const Topology found = topology(read_mesh(folder / "a.stl"));
  EXPECT_TRUE(found.solid()) << found;
  EXPECT_EQ(found.triangles, static_cast<std::int64_t>(mesh.triangles.size()) - 2);
  EXPECT_EQ(found.degenerate_triangles, 0);
}

TEST(WritePly, PropertiesStandBesideThePositions) {
  const TemporaryFolder folder;
  const Mesh mesh = cube_mesh();
  std::vector<float> quality(8);
  std::vector<std::uint8_t> red(8);
  for (int i = 0; i < 8; ++i) quality[i] = 0.5f * i, red[i] = static_cast<std::uint8_t>(250 + i % 6);
  const std::vector<VertexProperty> properties{{"quality", quality}, {"red", red}};
  write_ply(folder / "a.ply", mesh, properties);
  EXPECT_EQ(read_mesh(folder / "a.ply"), mesh);
  const std::string bytes = read_file(folder / "a.ply");
  EXPECT_THAT(bytes, HasSubstr("property double z\nproperty float quality\nproperty uchar red\n"));
  const std::size_t body = bytes.find("end_header\n") + 11, stride = 24 + 4 + 1;
  for (int i = 0; i < 8; ++i) {
    EXPECT_EQ(number_at<float>(bytes, body + stride * i + 24), quality[i]);
    EXPECT_EQ(number_at<std::uint8_t>(bytes, body + stride * i + 28), red[i]);
  }
}

TEST(WritePly, PropertiesThatDoNotFitAreRefused) {
  const TemporaryFolder folder;
  const auto write = [&](std::vector<VertexProperty> properties) {
    write_ply(folder / "a.ply", cube_mesh(), properties);
  };
  EXPECT_THAT(
      [&] {
        write({{"quality", std::vector<float>(7)}});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("each of the 8 vertices, got 7")));
  const std::vector<float> eight(8);
  for (const char* name : {"", "x", "two words", "line\nbreak"})
    EXPECT_THROW(write({{name, eight}}), std::invalid_argument) << name;
  EXPECT_THROW(write({{"a", eight}, {"a", eight}}), std::invalid_argument);
}

TEST(WritePly, APointCloudHasNoTriangles) {
  const TemporaryFolder folder;
  const Mesh cloud{cube_mesh().positions, {}};
  EXPECT_THROW(write_ply(folder / "a.ply", cloud, {}), std::invalid_argument);
  write_ply(folder / "a.ply", cloud, {}, {.strict = false});
  EXPECT_EQ(read_mesh(folder / "a.ply"), cloud);
}

}  // namespace
}  // namespace carve
