#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "carve/image/read_image.h"
#include "carve/mesh/mesh_io.h"
#include "eval/meshes.h"
#include "program.h"
#include "shapes.h"

namespace carve {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;

class Programs : public testing::Test {
 protected:
  Programs() {
    write_mesh(folder_ / "reference.ply", ball(20));
    write_mesh(folder_ / "compared.obj", ball(12, 1.1));
    write_mesh(folder_ / "open.ply", square(4), {.strict = false});
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string file(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return path(name);
  }
  Outcome run(const std::string& program, const std::string& arguments) const {
    return run_program(CARVE_EVALUATION "/" + program + " " + arguments);
  }
  // One line that names all of `parts`, nothing on stdout.
  static void expect_refused(const Outcome& outcome, const std::vector<std::string>& parts, int code = 2) {
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    for (const std::string& part : parts) EXPECT_THAT(outcome.err, HasSubstr(part));
  }
  // Every program that reads a mesh refuses this one.
  void expect_all_refuse(const std::string& bad) const {
    const std::string name = fs::path(bad).filename();
    expect_refused(run("mesh_check", bad), {"mesh_check: ", name});
    expect_refused(run("cloud_to_mesh", bad + " --reference " + path("reference.ply")), {"cloud_to_mesh: ", name});
    expect_refused(run("cloud_to_mesh", path("compared.obj") + " --reference " + bad), {"cloud_to_mesh: ", name});
    expect_refused(run("heat_map", bad + " --reference " + path("reference.ply") + " -o " + path("out.png")), {name});
    EXPECT_FALSE(fs::exists(path("out.png")));
  }

  const TemporaryFolder folder_;
};

std::string ply(const std::string& counts_and_body, int vertices = 3, const std::string& faces = "1") {
  return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertices) +
         "\nproperty double x\nproperty double y\nproperty double z\nelement face " + faces +
         "\nproperty list uchar int vertex_indices\nend_header\n" + counts_and_body;
}

TEST_F(Programs, RefuseTruncatedFiles) {
  const std::string whole = read_file(folder_ / "reference.ply");
  expect_all_refuse(file("half.ply", whole.substr(0, whole.size() / 2)));
  expect_all_refuse(file("head.ply", whole.substr(0, 40)));
  expect_all_refuse(file("empty.ply", ""));
}

TEST_F(Programs, RefuseCoordinatesThatAreNoNumbers) {
  expect_all_refuse(file("nan.ply", ply("0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n")));
  expect_all_refuse(file("inf.obj", "v 0 0 0\nv 1e999 0 0\nv 0 1 0\nf 1 2 3\n"));
}

TEST_F(Programs, RefuseIndicesOutOfRange) {
  expect_all_refuse(file("far.ply", ply("0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n")));
  expect_all_refuse(file("negative.ply", ply("0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n")));
}

TEST_F(Programs, RefuseCountsThatTheFileCannotHold) {
  expect_all_refuse(file("huge.ply", ply("0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", 3, "800000000")));
  expect_all_refuse(file("wide.ply", ply("0 0 0\n", 2000000000)));
  std::string stl(84, '\0');
  stl[80] = stl[81] = stl[82] = stl[83] = '\xff';
  expect_all_refuse(file("huge.stl", stl));
}

TEST_F(Programs, RefuseMissingFilesAndUnknownEndings) {
  expect_all_refuse(path("missing.ply"));
  expect_all_refuse(file("mesh.xyz", "0 0 0\n"));
}

TEST_F(Programs, RefuseWrongUsage) {
  expect_refused(run("cloud_to_mesh", ""), {"cloud_to_mesh: "});
  const std::string pair = path("compared.obj") + " --reference " + path("reference.ply");
  expect_refused(run("cloud_to_mesh", pair + " --samples 0"), {"samples", "[1, 1e+08]", "0"});
  expect_refused(run("cloud_to_mesh", pair + " --tolerances 1,x"), {"tolerances", "x"});
  expect_refused(run("cloud_to_mesh", pair + " --threads -1"), {"threads"});
  expect_refused(run("heat_map", pair + " -o " + path("a.jpg")), {"a.jpg", ".png, .ply or .vtp"});
  expect_refused(run("heat_map", path("open.ply") + " " + pair + " -o " + path("a.ply")), {"a.ply", "got 2"});
  expect_refused(run("heat_map", pair + " --views inside -o " + path("a.png")), {"views", "inside"});
  expect_refused(run("silhouette_check", path("compared.obj")), {"views must show all three axes"});
}

TEST_F(Programs, SayWhatTheyCannotWrite) {
  const std::string pair = path("compared.obj") + " --reference " + path("reference.ply");
  expect_refused(run("heat_map", pair + " -o /no/such/folder/a.png"), {"/no/such/folder/a.png"});
  expect_refused(run("cloud_to_mesh", pair + " --csv /no/such/folder/a.csv"), {"/no/such/folder/a.csv"});
}

TEST_F(Programs, CloudToMeshAgreesWithItselfInEveryForm) {
  const std::string arguments = path("compared.obj") + " " + path("reference.ply") + " --reference " +
                                path("reference.ply") + " --samples 5000 --iou-resolution 32 --tolerances 0.5,7";
  const Outcome text = run("cloud_to_mesh", arguments + " --csv " + path("a.csv"));
  const Outcome json = run("cloud_to_mesh", arguments + " --json --threads 1");
  ASSERT_EQ(text.code, 0) << text.err;
  ASSERT_EQ(json.code, 0) << json.err;
  const auto parsed = nlohmann::json::parse(json.out);
  ASSERT_EQ(parsed["results"].size(), 2u);
  const auto& values = parsed["results"][0]["values"];
  EXPECT_NEAR(values["c2m_thesis"]["value"].get<double>(), 0.1, 0.01);
  EXPECT_NEAR(values["c2m_signed_mean"]["value"].get<double>(), 0.1, 0.01);
  EXPECT_EQ(values["f_score@7%"]["value"], 1);
  EXPECT_EQ(values["closed"]["value"], 1);
  EXPECT_EQ(parsed["results"][1]["values"]["c2m_max"]["value"], 0);
  EXPECT_THAT(text.out, HasSubstr("f_score@0.5%"));
  EXPECT_THAT(read_file(folder_ / "a.csv"),
              HasSubstr(",c2m_thesis," + nlohmann::json(values["c2m_thesis"]["value"]).dump()));
}

TEST_F(Programs, ACloudIsMeasuredToo) {
  const std::string cloud = file("cloud.ply", ply("0 0 1.5\n0 1.5 0\n0 0 0\n", 3, "0"));
  const Outcome outcome = run("cloud_to_mesh", cloud + " --json --samples 100 --reference " + path("reference.ply"));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto values = nlohmann::json::parse(outcome.out)["results"][0]["values"];
  EXPECT_NEAR(values["c2m_thesis"]["value"].get<double>(), 2.0 / 3, 0.01);
  EXPECT_NEAR(values["c2m_signed_mean"]["value"].get<double>(), 0, 0.01);
  EXPECT_TRUE(values["volume_iou"]["value"].is_null());
}

TEST_F(Programs, MeshCheckTellsSolidsFromTheRest) {
  EXPECT_EQ(run("mesh_check", path("reference.ply") + " " + path("compared.obj")).code, 0);
  const Outcome open = run("mesh_check", path("reference.ply") + " " + path("open.ply"));
  EXPECT_EQ(open.code, 3);
  EXPECT_THAT(open.out, HasSubstr("open.ply: FAIL: 16 boundary edges"));
  write_mesh(folder_ / "crossing.ply", joined(ball(8), cube({1, 0, 0})));
  const Outcome crossing = run("mesh_check", path("crossing.ply") + " --json");
  EXPECT_EQ(crossing.code, 3);
  EXPECT_GT(nlohmann::json::parse(crossing.out)[0]["report"]["self_intersections"], 0);
  write_mesh(folder_ / "reversed.ply", turned_inside_out(ball(8)));
  const Outcome reversed = run("mesh_check", path("reversed.ply"));
  EXPECT_EQ(reversed.code, 3);
  EXPECT_THAT(reversed.out, HasSubstr("inside out"));
}

TEST_F(Programs, HeatMapWritesEveryForm) {
  const Outcome outcome =
      run("heat_map", path("compared.obj") + " --reference " + path("reference.ply") + " -o " + path("a.png") + " -o " +
                          path("a.ply") + " -o " + path("a.vtp") + " --range 10 --size 80");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("range 10 % of the reference's diagonal"));
  EXPECT_THAT(outcome.out, HasSubstr("compared: 0 % of the vertices beyond it"));
  EXPECT_GT(read_image(folder_ / "a.png").width, 300);
  EXPECT_EQ(read_mesh(folder_ / "a.ply").positions.size(), read_mesh(folder_ / "compared.obj").positions.size());
  EXPECT_THAT(read_file(folder_ / "a.vtp"), HasSubstr("Name=\"C2M\""));
}

TEST_F(Programs, SilhouetteCheckTellsWhatFits) {
  const Shape shape = carve::box({1, 0.75, 0.5});
  std::string views;
  for (const View view : kThreeViews) {
    const Drawing drawing = draw(shape, view);
    write_png(folder_ / (name(view) + std::string(".png")), drawing.picture);
    views += " --" + std::string(name(view)) + " " + path(name(view) + std::string(".png"));
  }
  write_mesh(folder_ / "box.ply",
             mapped(cube(), [](const Vec3& p) { return Vec3(p.x(), 0.75 * (p.y() + 0.5), 0.5 * p.z()); }));
  fs::create_directory(folder_ / "overlays");
  const Outcome fits = run("silhouette_check", path("box.ply") + views + " --overlays " + path("overlays"));
  EXPECT_EQ(fits.code, 0) << fits.err << fits.out;
  EXPECT_TRUE(fs::exists(folder_ / "overlays" / "side.png"));
  const Outcome differs = run("silhouette_check", path("reference.ply") + views + " --json");
  EXPECT_EQ(differs.code, 3) << differs.err;
  const auto report = nlohmann::json::parse(differs.out);
  EXPECT_FALSE(report["pass"]);
  EXPECT_EQ(report["fit"], "box");
  EXPECT_NEAR(report["views"]["front"]["silhouette_iou"].get<double>(), std::numbers::pi / 4, 0.02);
}

}  // namespace
}  // namespace carve
