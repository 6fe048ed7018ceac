#include <gmock/gmock.h>

#include <fstream>

#include "carve/core/error.h"
#include "carve/mesh/topology.h"
#include "models/primitives.h"
#include "models/procedural.h"
#include "models/shells.h"
#include "temporary_folder.h"

namespace carve {
namespace {

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "no error";
}

class ProceduralModelTest : public testing::TestWithParam<ProceduralModel> {};
INSTANTIATE_TEST_SUITE_P(All, ProceduralModelTest,
                         testing::ValuesIn(procedural_models().begin(), procedural_models().end()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST_P(ProceduralModelTest, EveryShellIsClosedAndOutward) {
  const Model model = GetParam().make();
  const Topology whole = topology(model.mesh);
  EXPECT_TRUE(whole.solid()) << whole;
  EXPECT_EQ(whole.degenerate_triangles, 0);
  EXPECT_EQ(whole.unused_vertices, 0);
  for (const Mesh& shell : shells(model.mesh)) EXPECT_GT(topology(shell).volume, 0);
}

TEST_P(ProceduralModelTest, StandsInObjectUnits) {
  const auto [low, high] = bounds(GetParam().make().mesh);
  EXPECT_NEAR((high - low).maxCoeff(), 1, 1e-12);
  EXPECT_NEAR(low.x() + high.x(), 0, 1e-12);
  EXPECT_NEAR(low.z() + high.z(), 0, 1e-12);
  EXPECT_EQ(low.y(), 0);
}

TEST_P(ProceduralModelTest, MaterialsAreUsedNamedAndNoneIsNearBlack) {
  const Model model = GetParam().make();
  ASSERT_EQ(model.material.size(), model.mesh.triangles.size());
  std::vector<int> uses(model.materials.size());
  for (const int m : model.material) ++uses.at(m);
  for (std::size_t i = 0; i < uses.size(); ++i) {
    EXPECT_GT(uses[i], 0) << model.materials[i].name;
    const Rgba c = model.materials[i].colour;
    EXPECT_GE(std::max({c.r, c.g, c.b}), 64) << model.materials[i].name;
    EXPECT_EQ(c.a, 255);
  }
}

TEST(ProceduralModels, AnUnknownNameIsAnsweredWithTheKnownOnes) {
  EXPECT_THAT(error_of([] { procedural_model("sofa"); }),
              testing::AllOf(testing::StartsWith("model must be one of axe|"), testing::EndsWith(", got sofa")));
}

TEST(ProceduralModels, TheHeadsBrowHidesItsNoseFromAbove) {
  const Model model = head();
  double brow = -1, nose = -1;
  for (const Vec3& p : model.mesh.positions) {
    if (p.y() > 0.60 && p.y() < 0.72) brow = std::max(brow, p.z());
    if (p.y() > 0.40 && p.y() < 0.52) nose = std::max(nose, p.z());
  }
  EXPECT_GT(brow, nose);
  EXPECT_GT(nose, brow - 0.03);  // and is one nevertheless
}

TEST(Primitives, HaveTheVolumesOfTheirBodies) {
  const double pi = std::acos(-1.0);
  EXPECT_NEAR(topology(box({0, 1, 2}, {1, 3, 5})).volume, 6, 1e-12);
  EXPECT_NEAR(topology(ellipsoid({1, 2, 3}, {0.5, 0.3, 0.2}, 200)).volume, 4 * pi / 3 * 0.03, 1e-4);
  EXPECT_NEAR(topology(cylinder({0, 0, 0}, {1, 2, 2}, 0.5, 400)).volume, 3 * pi / 4, 1e-3);
  EXPECT_NEAR(topology(cone({0, 0, 0}, {0, 3, 0}, 1, 0, 400)).volume, pi, 1e-3);
  EXPECT_NEAR(topology(torus({0, 0, 0}, 1, 1, 0.25, 400)).volume, 2 * pi * pi / 16, 1e-3);
  const Vec2 notched[] = {{0, 0}, {2, 0}, {2, 2}, {1, 1}, {0, 2}};
  EXPECT_NEAR(topology(prism(notched, 2, 0, 2)).volume, 6, 1e-12);
  // A box of radius r: the inner box, six slabs, quarter cylinders and eighths of a sphere.
  EXPECT_NEAR(topology(rounded_box({0, 0, 0}, {1, 1, 1}, 0.2, 40)).volume,
              0.216 + 6 * 0.2 * 0.36 + 3 * pi * 0.04 * 0.6 + 4 * pi / 3 * 0.008, 1e-3);
}

TEST(Primitives, AllAreSolid) {
  const Vec3 path[] = {{0, 0, 0}, {0, 1, 0}, {1, 2, 0.5}, {2, 2, 1}};
  const double radii[] = {0.1, 0.2, 0.2, 0.1};
  const Section sections[] = {{{0, 0, 0}, 1, 2, 3}, {{0.2, 0, 3}, 0.5, 1, 8}};
  for (const Mesh& mesh :
       {tube(path, radii), body(sections, 2), rounded_box({0, 0, 0}, {1, 2, 3}, 0.2), cone({0, 0, 0}, {0, 1, 0}, 0, 1),
        mirrored(tube(path, radii), 0), turned(box({0, 0, 0}, {1, 2, 3}), 1, 30)}) {
    const Topology t = topology(mesh);
    EXPECT_TRUE(t.solid());
    EXPECT_EQ(t.degenerate_triangles, 0);
    EXPECT_GT(t.volume, 0);
  }
}

TEST(Primitives, PolygonisingABallConvergesToIt) {
  const auto ball = [](const Vec3& p) { return p.norm() - 1; };
  const double volume = 4 * std::acos(-1.0) / 3;
  double last = 1;
  for (const double spacing : {0.2, 0.1, 0.05}) {
    const Topology t = topology(polygonise(ball, Vec3::Constant(-1.13), Vec3::Constant(1.13), spacing));
    EXPECT_TRUE(t.solid());
    EXPECT_EQ(t.genus, 0);
    const double error = std::abs(t.volume / volume - 1);
    EXPECT_LT(error, last / 2);
    last = error;
  }
  EXPECT_LT(last, 2e-3);
}

class ObjModelTest : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder / name) << text;
    return folder / name;
  }
  std::string load_error(const std::string& obj) const {
    const auto path = write("bad.obj", obj);
    std::string error = error_of([&] { load_model(path); });
    const std::size_t at = error.find(folder.path().string());
    if (at != std::string::npos) error.erase(at, folder.path().string().size() + 1);
    return error;
  }
  TemporaryFolder folder;
};

TEST_F(ObjModelTest, ReadsBackWhatWasWritten) {
  Model model = couch();
  model.materials[1].texture = Picture(3, 2, {10, 20, 30, 255});
  for (std::size_t i = 0; i < 3 * model.mesh.triangles.size(); ++i)
    model.uv.emplace_back(0.1 * (i % 11), 1.0 / (i + 1));
  write_model(folder.path(), model);
  const Model read = load_model(folder / "model.obj");
  EXPECT_EQ(read.mesh, model.mesh);
  EXPECT_EQ(read.material, model.material);
  EXPECT_EQ(read.uv, model.uv);
  ASSERT_EQ(read.materials.size(), model.materials.size());
  for (std::size_t i = 0; i < read.materials.size(); ++i) {
    EXPECT_EQ(read.materials[i].name, model.materials[i].name);
    EXPECT_EQ(read.materials[i].colour, model.materials[i].colour);
    EXPECT_EQ(read.materials[i].texture, model.materials[i].texture);
  }
}

TEST_F(ObjModelTest, PolygonsNegativeIndicesAndMissingMaterialsAreRead) {
  const Model model =
      load_model(write("a.obj", "v 0 0 0\r\nv 1 0 0\nv 1 1 0 # corner\nv 0 1 0\ns off\nf -4 -3// 3//1 4\n"));
  EXPECT_EQ(model.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_TRUE(model.uv.empty());
  EXPECT_EQ(model.materials.size(), 1u);
}

TEST_F(ObjModelTest, ErrorsNameFileAndLine) {
  EXPECT_EQ(load_error("v 0 0 0\nv 1 x 0\n"), "bad.obj:2: v must be a finite number, got x");
  EXPECT_EQ(load_error("v 0 0\n"), "bad.obj:1: v must have 3 values or more");
  EXPECT_EQ(load_error("v 0 0 0\nf 1 1 2\n"), "bad.obj:2: f: vertex index must be in [1, 1], got 2");
  EXPECT_EQ(load_error("v 0 0 0\nf 1 0 1\n"), "bad.obj:2: f: vertex index must be in [1, 1], got 0");
  EXPECT_EQ(load_error("v 0 0 0\nf 1/1 1 1\n"), "bad.obj:2: f: texture index must be in [1, 0], got 1");
  EXPECT_EQ(load_error("v 0 0 0\nf 1 1\n"), "bad.obj:2: f must have at least 3 corners, got 2");
  EXPECT_EQ(load_error("usemtl gold\n"), "bad.obj:1: usemtl gold: no such material");
  EXPECT_EQ(load_error("mtllib none.mtl\n"), "none.mtl: no such file");
  EXPECT_EQ(load_error("v 0 0 0\n"), "bad.obj: no faces");
  write("m.mtl", "newmtl a\nKd 1 nan 0\n");
  EXPECT_EQ(load_error("mtllib m.mtl\n"), "m.mtl:2: Kd must be a finite number, got nan");
}

}  // namespace
}  // namespace carve
