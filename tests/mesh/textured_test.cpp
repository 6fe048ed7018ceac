// Meshes with a texture as files: by our own reader, and by other people's where they are installed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "carve/core/error.h"
#include "carve/image/read_image.h"
#include "carve/mesh/mesh_io.h"
#include "carve/mesh/topology.h"
#include "mesh/solids.h"
#include "program.h"

namespace carve {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// Every triangle a chart of its own: the most seams a mesh can have.
TexturedMesh shattered(const Mesh& mesh) {
  TexturedMesh model{mesh, {}, {}, Picture(8, 8)};
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      model.texture(x, y) = {static_cast<std::uint8_t>(30 * x), static_cast<std::uint8_t>(30 * y), 77, 255};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const double x = static_cast<double>(t % 7) / 8, y = static_cast<double>(t / 7 % 7) / 8;
    const int first = static_cast<int>(model.uvs.size());
    for (const Vec2& corner : {Vec2(0, 0.125), Vec2(0.125, 0), Vec2(0, 0)}) model.uvs.push_back(Vec2(x, y) + corner);
    model.uv_triangles.push_back({first, first + 1, first + 2});
  }
  return model;
}

bool is_installed(const std::string& program) { return run_program("command -v " + program).code == 0; }

class Textured : public ::testing::TestWithParam<const char*> {
 protected:
  std::filesystem::path path() const { return folder_ / (std::string("model.") + GetParam()); }
  const TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Formats, Textured, ::testing::Values("glb", "obj"));

TEST_P(Textured, ReadsBackAsTheSameSolid) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const Mesh mesh = random_solid(seed);
    write_textured_mesh(path(), shattered(mesh));
    const Topology before = topology(mesh), after = topology(read_mesh(path()));
    EXPECT_TRUE(after.solid());
    EXPECT_EQ(after.vertices, before.vertices);
    EXPECT_EQ(after.edges, before.edges);
    EXPECT_EQ(after.triangles, before.triangles);
    EXPECT_NEAR(after.volume, before.volume, 1e-5 * std::abs(before.volume));
  }
}

TEST_P(Textured, AssimpFindsOneMaterialWithAPicture) {
  if (!is_installed("assimp")) GTEST_SKIP() << "assimp is not installed (Debian package assimp-utils)";
  write_textured_mesh(path(), shattered(shaken(ball_mesh(4), 2, 0.001)));
  const Outcome found = run_program("assimp info " + path().string());
  ASSERT_EQ(found.code, 0) << found.out;
  EXPECT_THAT(found.out, HasSubstr("Materials:          1"));
  EXPECT_THAT(found.out,
              HasSubstr(GetParam() == std::string("glb") ? "Textures (embed.):  1" : "Textures (embed.):  0"));
  // Written out again by assimp, corners still know their places.
  const std::string again = (folder_ / "again.obj").string();
  ASSERT_EQ(run_program("assimp export " + path().string() + " " + again).code, 0);
  const std::string text = read_file(again);
  EXPECT_THAT(text, HasSubstr("\nvt "));
}

TEST_P(Textured, BlenderOpensItWithItsPicture) {
  if (!is_installed("blender")) GTEST_SKIP() << "blender is not installed (Debian package blender)";
  const TexturedMesh model = shattered(ball_mesh(3));
  write_textured_mesh(path(), model);
  const Outcome found =
      run_program("blender -b --factory-startup -P " CARVE_TESTS "/mesh/open_in_blender.py -- " + path().string());
  EXPECT_THAT(found.out, HasSubstr(std::to_string(model.mesh.triangles.size()) + " triangles, UV in [0.")) << found.err;
  EXPECT_THAT(found.out, HasSubstr("picture 8x8 sRGB\n"));
}

TEST_P(Textured, WithoutATextureIsThePlainMesh) {
  const Mesh mesh = ball_mesh(3);
  write_textured_mesh(path(), TexturedMesh{mesh, {}, {}, {}});
  const std::string textured = read_file(path());
  write_mesh(path(), mesh);
  EXPECT_EQ(textured, read_file(path()));
}

TEST_P(Textured, CoordinatesThatDoNotFitAreRefused) {
  const auto refused = [&](const TexturedMesh& model, const char* why) {
    EXPECT_THAT([&] { write_textured_mesh(path(), model); }, ThrowsMessage<std::invalid_argument>(HasSubstr(why)));
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
  };
  const TexturedMesh good = shattered(ball_mesh(2));
  TexturedMesh model = good;
  model.uv_triangles.pop_back();
  refused(model, "uv_triangles must be as many");
  model = good, model.uv_triangles[3][1] = static_cast<int>(model.uvs.size());
  refused(model, "uv_triangles must index one of");
  model = good, model.uvs[5].x() = std::numeric_limits<double>::quiet_NaN();
  refused(model, "uvs must be finite");
}

TEST(TexturedObj, NamesItsMaterialAndThatItsPicture) {
  const TemporaryFolder folder;
  const TexturedMesh model = shattered(ball_mesh(2));
  write_textured_mesh(folder / "a.obj", model);
  EXPECT_THAT(read_file(folder / "a.obj"), HasSubstr("mtllib a.mtl\n"));
  EXPECT_THAT(read_file(folder / "a.mtl"), HasSubstr("map_Kd a.png\n"));
  EXPECT_EQ(read_image(folder / "a.png"), model.texture);
  EXPECT_THAT(read_file(folder / "a.png"), HasSubstr("sRGB"));
}

TEST(TexturedGlb, ReadsBackWithItsTexture) {
  const TemporaryFolder folder;
  for (unsigned seed = 0; seed < 6; ++seed) {
    const TexturedMesh model = shattered(random_solid(seed));
    write_textured_mesh(folder / "a.glb", model);
    const TexturedMesh back = read_textured_mesh(folder / "a.glb");
    EXPECT_EQ(back.texture, model.texture);
    EXPECT_TRUE(topology(back.mesh).solid());
    ASSERT_EQ(back.uv_triangles.size(), model.uv_triangles.size());
    for (std::size_t t = 0; t < model.uv_triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        const auto position = [&](const TexturedMesh& m) { return m.mesh.positions[m.mesh.triangles[t][k]]; };
        EXPECT_LT((position(back) - position(model)).norm(), 1e-5);
        EXPECT_LT((back.uvs[back.uv_triangles[t][k]] - model.uvs[model.uv_triangles[t][k]]).norm(), 1e-6);
      }
  }
  write_mesh(folder / "plain.glb", ball_mesh(2));
  EXPECT_THROW(read_textured_mesh(folder / "plain.glb"), IoError);
  EXPECT_THROW(read_textured_mesh(folder / "a.obj"), IoError);
}

TEST(TexturedGlb, HoldsThePicture) {
  const TemporaryFolder folder;
  const TexturedMesh model = shattered(ball_mesh(2));
  write_textured_mesh(folder / "a.glb", model);
  EXPECT_THAT(read_file(folder / "a.glb"), HasSubstr(encode_png(model.texture)));
}

TEST(TexturedGlb, TheValidatorFindsNothing) {
  const TemporaryFolder folder;
  std::string files;
  for (unsigned seed = 0; seed < 6; ++seed) {
    const auto path = folder / (std::to_string(seed) + ".glb");
    write_textured_mesh(path, shattered(random_solid(seed)));
    files += " " + path.string();
  }
  write_textured_mesh(folder / "large.glb", shattered(torus_mesh(200, 200)));  // needs 32-bit indices
  const Outcome outcome =
      run_program("node " CARVE_TESTS "/mesh/validate_gltf.mjs" + files + " " + (folder / "large.glb").string());
  if (outcome.code == 77 || outcome.code == 127) GTEST_SKIP() << outcome.out << outcome.err;
  EXPECT_EQ(outcome.code, 0) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("0 errors, 0 warnings, 0 infos, 240000 vertices, 80000 triangles"));
}

}  // namespace
}  // namespace carve
