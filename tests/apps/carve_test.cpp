#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "carve/image/read_image.h"
#include "carve/mesh/mesh_io.h"
#include "carve/mesh/topology.h"
#include "program.h"

namespace carve {
namespace {
namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

// Red where `inside` says so, on a transparent picture.
template <class Inside>
Picture painted(int size, Inside&& inside) {
  Picture picture(size, size, {0, 0, 0, 0});
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      if (inside(x, y)) picture(x, y) = {200, 60, 60, 255};
  return picture;
}

Picture disc(int size) {
  return painted(size,
                 [=](int x, int y) { return std::hypot(x + 0.5 - size / 2.0, y + 0.5 - size / 2.0) < 0.4 * size; });
}

class CarveProgram : public testing::Test {
 protected:
  CarveProgram() {
    for (const char* view : {"front", "side", "top"}) write_png(folder_ / (view + std::string(".png")), disc(96));
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  Outcome carve(const std::string& arguments) const { return run_program(CARVE_PROGRAM " " + arguments); }
  std::string views() const {
    return "--front " + path("front.png") + " --side " + path("side.png") + " --top " + path("top.png");
  }
  Outcome build(const std::string& more) const { return carve("build " + views() + " --grid 32 " + more); }

  // One line on stderr that says all of `parts`, nothing on stdout, the code, and no file left behind.
  void expect_refused(const Outcome& outcome, const std::vector<std::string>& parts, int code = 2) const {
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    for (const std::string& part : parts) EXPECT_THAT(outcome.err, HasSubstr(part));
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_.path()))
      EXPECT_THAT(entry.path().filename().string(), testing::Not(HasSubstr("out"))) << "left behind";
  }
  // Nothing on a fast machine; on a slow one "carve: 12 % stage", never going back.
  static void expect_progress_at_most(const std::string& err) {
    std::istringstream lines(err);
    int last = 0;
    for (std::string line; std::getline(lines, line);) {
      int percent = -1;
      EXPECT_EQ(std::sscanf(line.c_str(), "carve: %d %%", &percent), 1) << line;
      EXPECT_GE(percent, last) << err;
      EXPECT_LE(percent, 100) << err;
      last = percent;
    }
  }
  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }

  const TemporaryFolder folder_;
};

TEST_F(CarveProgram, BuildsAnExactHullByEveryMethod) {
  double volume = 0;
  for (const char* method : {"strips", "corefinement", "nef"}) {
    const std::string out = path(std::string("exact_") + method + ".ply");
    ASSERT_EQ(build(std::string("--contour-tolerance 1 --hull ") + method + " -o " + out).code, 0);
    const Topology t = topology(read_mesh(out));
    EXPECT_TRUE(t.solid());
    EXPECT_NEAR(t.volume, volume == 0 ? t.volume : volume, 1e-12);
    volume = t.volume;
  }
}

TEST_F(CarveProgram, BuildsASolidInEveryFormat) {
  for (const char* name : {"out.glb", "out.obj", "out.ply", "out.stl", "out.off"}) {
    const Outcome outcome = build("-o " + path(name));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    expect_progress_at_most(outcome.err);
    EXPECT_TRUE(topology(read_mesh(path(name))).solid()) << name;
  }
}

TEST_F(CarveProgram, TexturesWhatCanHoldATexture) {
  const auto has = [&](const std::string& more, const char* name, const char* what) {
    const Outcome outcome = build(more + " --atlas-size 256 -o " + path(name));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return read_file(path(name)).find(what) != std::string::npos;
  };
  EXPECT_TRUE(has("", "out.glb", "image/png"));
  EXPECT_TRUE(has("--texture blend", "out.glb", "image/png"));
  EXPECT_FALSE(has("--texture none", "out.glb", "image/png"));
  EXPECT_TRUE(has("", "out.obj", "map_Kd") || has("", "out.obj", "mtllib out.mtl"));
  EXPECT_EQ(read_image(path("out.png")).width, 256);
  EXPECT_EQ(build("-o " + path("out.ply")).code, 0);
}

TEST_F(CarveProgram, ATextureIsNeverDroppedSilently) {
  expect_refused(build("--texture best_view -o " + path("out.stl")), {"out.stl", "--texture none"});
  expect_refused(build("--atlas-size 9000 -o " + path("out.glb")), {"atlas.size", "[16, 8192]"});
  expect_refused(build("--texture best -o " + path("out.glb")), {"texture.arm", "best_view"});
}

TEST_F(CarveProgram, APictureBesideTheMeshNeverReplacesADrawing) {
  const std::string before = read_file(path("front.png"));
  expect_refused(build("-o " + path("front.obj")), {"front.png", "must not be the front drawing"});
  EXPECT_EQ(read_file(path("front.png")), before);
  EXPECT_EQ(build("--texture none -o " + path("front.obj")).code, 0);
}

TEST_F(CarveProgram, TheMeshIsCentredStandsOnTheGroundAndHasLongestSideOne) {
  ASSERT_EQ(build("--smooth-steps 0 -o " + path("out.ply")).code, 0);
  Eigen::AlignedBox3d box;
  for (const Vec3& p : read_mesh(path("out.ply")).positions) box.extend(p);
  const double voxel = 1.0 / 32;
  EXPECT_NEAR(box.sizes().maxCoeff(), 1, voxel);
  EXPECT_NEAR(box.center().x(), 0, voxel / 2);
  EXPECT_NEAR(box.center().z(), 0, voxel / 2);
  EXPECT_NEAR(box.min().y(), 0, voxel / 2);
}

TEST_F(CarveProgram, ThreadsDoNotChangeTheBytes) {
  ASSERT_EQ(build("--threads 1 -o " + path("out1.glb")).code, 0);
  ASSERT_EQ(build("--threads 2 -o " + path("out2.glb")).code, 0);
  EXPECT_EQ(read_file(path("out1.glb")), read_file(path("out2.glb")));
}

TEST_F(CarveProgram, TwoToSixViewsAreTaken) {
  const std::string f = " " + path("front.png");
  EXPECT_EQ(carve("build --front" + f + " --top" + f + " -o " + path("out.ply")).code, 0);
  EXPECT_EQ(carve("build --front" + f + " --side" + f + " --top" + f + " --back" + f + " --left" + f + " --bottom" + f +
                  " -o " + path("out.ply"))
                .code,
            0);
}

TEST_F(CarveProgram, ReportsWhatItDidAsJson) {
  ASSERT_EQ(build("-o " + path("out.glb") + " --json " + path("out.json")).code, 0);
  const auto report = nlohmann::json::parse(read_file(path("out.json")));
  EXPECT_TRUE(report["mesh"]["closed"] && report["mesh"]["manifold"] && report["mesh"]["oriented"]);
  EXPECT_EQ(report["options"]["grid"], 32);
  EXPECT_EQ(report["views"]["side"]["background"], "alpha");
}

TEST_F(CarveProgram, RefinesInTheOrderThatIsAskedForAndDecimatesLast) {
  ASSERT_EQ(build("-o " + path("a.ply") + " --refine remesh tangential --faces 500 --json " + path("r.json")).code, 0);
  const auto report = nlohmann::json::parse(std::ifstream(folder_ / "r.json"));
  std::vector<std::string> stages;
  for (const auto& step : report["refinement"]) {
    stages.push_back(step["stage"]);
    EXPECT_TRUE(step["kept"]);
  }
  EXPECT_EQ(stages, (std::vector<std::string>{"remesh", "tangential", "decimate"}));
  EXPECT_NEAR(topology(read_mesh(folder_ / "a.ply")).triangles, 500, 5);
}

TEST_F(CarveProgram, UnknownRefinement) {
  expect_refused(build("-o " + path("out.ply") + " --refine polish"), {"refine.arm", "remesh", "polish"});
  expect_refused(build("-o " + path("out.ply") + " --refine decimate"), {"decimate", "faces"});
}

TEST_F(CarveProgram, ConfigReadsBackAndFlagsAfterItWin) {
  ASSERT_EQ(carve("config " + path("options.toml")).code, 0);
  EXPECT_EQ(carve("build " + views() + " --config " + path("options.toml") + " --grid 16 -o " + path("out.ply") +
                  " --json " + path("out.json"))
                .code,
            0);
  EXPECT_EQ(nlohmann::json::parse(read_file(path("out.json")))["options"]["grid"], 16);
  write("bad.toml", "grid = 5\n");
  fs::remove(path("out.ply")), fs::remove(path("out.json"));
  expect_refused(build("--config " + path("bad.toml") + " -o " + path("out.ply")),
                 {"bad.toml:1: grid must be", "[8, 2048], got 5"});
}

TEST_F(CarveProgram, InfoTellsWhatWasUnderstood) {
  const Outcome outcome = carve("info --json " + path("front.png") + " " + path("top.png"));
  ASSERT_EQ(outcome.code, 0);
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json[0]["view"], "front");
  EXPECT_EQ(json[0]["width"], 96);
  EXPECT_EQ(json[1]["axes"], "image right = +X, image up = -Z, seen from +Y");
}

TEST_F(CarveProgram, HelpHasExamplesAndExitCodes) {
  const Outcome outcome = carve("build --help");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("Examples:"), HasSubstr("--smooth-steps")));
  EXPECT_THAT(carve("--help").out, HasSubstr("Exit codes"));
}

TEST_F(CarveProgram, MissingFile) {
  expect_refused(carve("build --front no.png --top no.png -o " + path("out.ply")), {"no.png: no such file"});
}

TEST_F(CarveProgram, NotAnImage) {
  write("front.png", "this is text");
  expect_refused(build("-o " + path("out.ply")), {"front.png: "});
}

TEST_F(CarveProgram, TruncatedPng) {
  const std::string whole = read_file(path("front.png"));
  write("front.png", whole.substr(0, whole.size() / 2));
  expect_refused(build("-o " + path("out.ply")), {"front.png: "});
}

TEST_F(CarveProgram, ImageBomb) {
  std::string png = read_file(path("front.png"));
  const std::string huge = {0, 1, char(0x86), char(0xa0)};  // 100000
  png.replace(16, 4, huge).replace(20, 4, huge);
  write("front.png", png);
  expect_refused(build("-o " + path("out.ply")), {"front.png: ", "16384", "100000"});
}

TEST_F(CarveProgram, EmptyFile) {
  write("front.png", "");
  expect_refused(build("-o " + path("out.ply")), {"front.png: "});
}

TEST_F(CarveProgram, FullyBackground) {
  write_png(path("front.png"), Picture(64, 64, {0, 0, 0, 0}));
  expect_refused(build("-o " + path("out.ply")), {"front.png: "});
}

TEST_F(CarveProgram, OnlyOneView) {
  expect_refused(carve("build --front " + path("front.png") + " -o " + path("out.ply")),
                 {"views must show all three axes", "add one of"});
}

TEST_F(CarveProgram, ViewsThatShareNoAxis) {
  expect_refused(
      carve("build --front " + path("front.png") + " --back " + path("front.png") + " -o " + path("out.ply")),
      {"nothing shows z"});
}

TEST_F(CarveProgram, SilhouettesWithoutACommonVoxel) {
  // The front shows two opposite corners, the others the middle and two dots that make their boxes as large: at the
  // front's corners the top's dots and the side's lie at different depths.
  const auto middle = [](int x, int y) { return x >= 24 && x < 40 && y >= 24 && y < 40; };
  const auto corner = [](int x, int y) { return (x == 0 || x == 63) && (y == 0 || y == 63); };
  write_png(path("front.png"), painted(64, [](int x, int y) { return (x < 8 && y >= 56) || (x >= 56 && y < 8); }));
  write_png(path("side.png"), painted(64, [&](int x, int y) { return middle(x, y) || (corner(x, y) && x != y); }));
  write_png(path("top.png"), painted(64, [&](int x, int y) { return middle(x, y) || (corner(x, y) && x == y); }));
  expect_refused(build("-o " + path("out.ply")), {"no voxel in common"}, 1);
}

TEST_F(CarveProgram, OptionsOutOfRange) {
  expect_refused(carve("build " + views() + " --grid 5 -o " + path("out.ply")),
                 {"grid must be a whole number in [8, 2048], got 5"});
  expect_refused(carve("build " + views() + " --grid 1e9 -o " + path("out.ply")), {"got 1e9"});
  expect_refused(build("--smooth-level nan -o " + path("out.ply")), {"smooth.level must be in [0, 180], got nan"});
  expect_refused(build("--patch most -o " + path("out.ply")), {"centre|any"});
  expect_refused(build("--no-such-flag -o " + path("out.ply")), {"--no-such-flag"});
}

TEST_F(CarveProgram, UnwritableOutput) {
  expect_refused(build("-o " + path("no/such/folder.ply")), {"folder.ply: cannot write"});
  expect_refused(build("-o /dev/full"), {"/dev/full"});
  expect_refused(build("-o " + path("name.xyz")), {"name.xyz", ".glb"});
}

TEST_F(CarveProgram, AFullDiskLeavesNothingBehind) {
  expect_refused(run_program("trap '' XFSZ; ulimit -f 8; " CARVE_PROGRAM " build " + views() + " --grid 64 -q -o " +
                             path("out.ply")),
                 {"out.ply: cannot write"}, 1);
}

TEST_F(CarveProgram, TheInputIsNeverOverwritten) {
  const std::string before = read_file(path("front.png"));
  fs::create_symlink(path("front.png"), path("link.glb"));
  expect_refused(build("-o " + path("link.glb")), {"must not be the front drawing"});
  EXPECT_EQ(read_file(path("front.png")), before);
}

}  // namespace
}  // namespace carve
