// What other people's readers make of our files. Without these programs the tests are skipped, and say so.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>

#include "carve/mesh/mesh_io.h"
#include "carve/mesh/ply.h"
#include "mesh/solids.h"
#include "temporary_folder.h"

namespace carve {
namespace {

using ::testing::HasSubstr;

struct Outcome {
  int code = 0;
  std::string output;
};

Outcome run(const std::string& command) {
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  Outcome outcome;
  char buffer[4096];
  while (const std::size_t size = std::fread(buffer, 1, sizeof buffer, pipe)) outcome.output.append(buffer, size);
  const int status = pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

bool is_installed(const std::string& program) { return run("command -v " + program).code == 0; }

// A line "name:   value" of assimp's report.
std::string field(const std::string& report, const std::string& name) {
  const std::size_t at = report.find("\n" + name);
  if (at == std::string::npos) return "";
  const std::size_t begin = report.find_first_not_of(" :", at + 1 + name.size());
  return report.substr(begin, report.find('\n', begin) - begin);
}

class Assimp : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!is_installed("assimp")) GTEST_SKIP() << "assimp is not installed (Debian package assimp-utils)";
  }
};
INSTANTIATE_TEST_SUITE_P(Formats, Assimp, ::testing::Values("ply", "obj", "stl", "glb", "off"));

TEST_P(Assimp, FindsTheSameVerticesAndTriangles) {
  const TemporaryFolder folder;
  for (const Mesh& mesh : {shaken(torus_mesh(), 1, 0.01), shaken(ball_mesh(4), 2, 0.001)}) {
    const auto path = folder / (std::string("mesh.") + GetParam());
    write_mesh(path, mesh);
    // STL does not share corners between triangles; raw, assimp does not join them.
    const bool shared = GetParam() != std::string("stl");
    const Outcome found = run("assimp info " + path.string() + (shared ? "" : " --raw"));
    ASSERT_EQ(found.code, 0) << found.output;
    const std::size_t vertices = shared ? mesh.positions.size() : 3 * mesh.triangles.size();
    EXPECT_EQ(field(found.output, "Vertices"), std::to_string(vertices)) << found.output;
    EXPECT_EQ(field(found.output, "Faces"), std::to_string(mesh.triangles.size())) << found.output;
    EXPECT_EQ(field(found.output, "Primitive Types"), "triangles") << found.output;
  }
}

TEST_P(Assimp, FindsTheBoxWhereItIs) {
  const TemporaryFolder folder;
  Mesh box = cube_mesh();
  for (Vec3& p : box.positions) p = Vec3(p.x() - 0.5, 0.25 * p.y(), 0.5 * p.z() - 0.125);
  const auto path = folder / (std::string("box.") + GetParam());
  write_mesh(path, box);
  const std::string report = run("assimp info " + path.string()).output;
  const bool z_up = GetParam() == std::string("stl");
  EXPECT_EQ(field(report, "Minimum point"), z_up ? "(-0.500000 -0.375000 0.000000)" : "(-0.500000 0.000000 -0.125000)");
  EXPECT_EQ(field(report, "Maximum point"), z_up ? "(0.500000 0.125000 0.250000)" : "(0.500000 0.250000 0.375000)");
}

TEST_F(Assimp, ReadsPastVertexProperties) {
  const TemporaryFolder folder;
  const Mesh mesh = ball_mesh(2);
  const std::size_t size = mesh.positions.size();
  const std::vector<VertexProperty> properties{{"red", std::vector<std::uint8_t>(size, 200)},
                                               {"green", std::vector<std::uint8_t>(size, 100)},
                                               {"blue", std::vector<std::uint8_t>(size, 50)},
                                               {"quality", std::vector<float>(size, 0.25f)}};
  write_ply(folder / "a.ply", mesh, properties);
  const std::string report = run("assimp info " + (folder / "a.ply").string()).output;
  EXPECT_EQ(field(report, "Vertices"), std::to_string(size));
  EXPECT_EQ(field(report, "Faces"), std::to_string(mesh.triangles.size()));
}

TEST(GltfValidator, FindsNothing) {
  const TemporaryFolder folder;
  std::string files;
  for (unsigned seed = 0; seed < 6; ++seed) {
    const auto path = folder / (std::to_string(seed) + ".glb");
    write_mesh(path, random_solid(seed));
    files += " " + path.string();
  }
  write_mesh(folder / "large.glb", torus_mesh(300, 300));  // needs 32-bit indices
  Mesh open = torus_mesh();                                // what strict would refuse
  open.triangles.resize(open.triangles.size() / 2);
  open.triangles.push_back({1, 1, 2});
  open.triangles.push_back({3, 4, 5});
  open.triangles.push_back({3, 5, 4});
  write_mesh(folder / "open.glb", open, {.strict = false});
  files += " " + (folder / "large.glb").string() + " " + (folder / "open.glb").string();
  const Outcome outcome = run("node " CARVE_TESTS "/mesh/validate_gltf.mjs" + files);
  if (outcome.code == 77 || outcome.code == 127) GTEST_SKIP() << outcome.output;
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("0 errors, 0 warnings, 0 infos, 90000 vertices, 180000 triangles"));
}

}  // namespace
}  // namespace carve
