#include <gmock/gmock.h>

#include <fstream>

#include "program.h"
#include "store/record.h"

// Methods that other programs do, with scripts in their place.

namespace carve {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;

class ExternalTest : public testing::Test {
 protected:
  // Runs an arm on four photos of the sphere with `variables` before the command; the record of its only run.
  experiments::Record run(const std::string& arm, const std::string& variables, const std::string& more = "") {
    std::ofstream(folder_ / "s.toml") << "models = [\"sphere\"]\nmetrics = [\"c2m_thesis\"]\n"
                                      << "options = { grid = 24, synthesize = { size = 64, samples = 1 }, rig = { "
                                      << rig_ << " }, "
                                      << "evaluate = { samples = 500, iou_resolution = 16 }, external = { angle = 90"
                                      << more << " } }\n"
                                      << "[[method]]\nname = \"m\"\narm = \"" << arm << "\"\n";
    outcome_ = run_program(variables + " " CARVE_EXPERIMENTS_PROGRAM " run " + (folder_ / "s.toml").string() + " -o " +
                           (folder_ / "r").string());
    const fs::path record = folder_ / "r/s/sphere/m/seed=1/run.json";
    return experiments::record_from_json(read_file(record), record.string());
  }
  const std::string fakes_ = "PATH=" CARVE_FAKE_PROGRAMS ":$PATH";
  std::string rig_ = "views = 4, top = false, size = 48";
  const TemporaryFolder folder_;
  Outcome outcome_;
};

TEST_F(ExternalTest, WhatIsNotInstalledIsSaidAndIsNoError) {
  for (const char* program : {"colmap", "pmvs2", "cmvs"}) {
    const std::string said = std::string("not installed: ") + program;
    EXPECT_EQ(run(program, "PATH=" + folder_.path().string()).status, said);
    EXPECT_EQ(outcome_.code, 0);
    EXPECT_THAT(outcome_.out, HasSubstr("0 failed, 1 not installed"));
    EXPECT_THAT(run_program(CARVE_EXPERIMENTS_PROGRAM " table -o " + (folder_ / "r").string()).out, HasSubstr(said));
  }
}

TEST_F(ExternalTest, PointsOfAProgramBecomeAMeshAndTheRecordNamesIt) {
  for (const auto& [program, version] :
       {std::pair("pmvs2", "pmvs2, hash "), std::pair("colmap", "colmap, COLMAP 0.0")}) {
    experiments::Record record = run(program, fakes_);
    ASSERT_EQ(record.status, "done");
    EXPECT_EQ(record.metrics["points"], 3000);
    EXPECT_LT(record.metrics["points_accuracy"], 0.5);
    EXPECT_LT(record.metrics["c2m_thesis"], 1);
    EXPECT_GT(record.metrics["iou"], 0.95);  // a surface turned inside out has none
    EXPECT_THAT(record.provenance["external"], HasSubstr(std::string(CARVE_FAKE_PROGRAMS "/") + version));
  }
}

// The scripts put photos 0, 1, 2 in one cluster and 1, 2, 3 in another, and each gives its points.
TEST_F(ExternalTest, PointsOfAllClustersOfCmvsBecomeAMesh) {
  rig_ = "views = 4, top = false, step = 12, size = 96";
  experiments::Record record = run("cmvs", fakes_, ", max_images = 3 }, pmvs = { threshold = 0.65, min_image_num = 2");
  ASSERT_EQ(record.status, "done");
  EXPECT_EQ(record.metrics["points"], 6000);
  EXPECT_LT(record.metrics["points_accuracy"], 0.5);
  EXPECT_GT(record.metrics["iou"], 0.95);
  EXPECT_EQ(record.provenance["clusters"], "3, 3 of 4 photos");
  for (const char* program : {"cmvs", "genOption", "pmvs2"})
    EXPECT_THAT(record.provenance["external"], HasSubstr(CARVE_FAKE_PROGRAMS "/" + std::string(program) + ", hash "));
}

TEST_F(ExternalTest, WithoutFeaturesCmvsDoesNotRun) {
  rig_ = "views = 4, top = false, step = 12, size = 96";
  EXPECT_THAT(run("cmvs", fakes_, " }, photograph = { style = \"flat\"").status, HasSubstr("no feature"));
}

TEST_F(ExternalTest, AProgramThatHangsIsStopped) {
  EXPECT_THAT(run("pmvs2", fakes_ + " FAKE_SLEEP=60", ", seconds = 0.5").status, HasSubstr("stopped after 0.5 s"));
  EXPECT_EQ(outcome_.code, 1);
}

TEST_F(ExternalTest, AProgramThatFailsIsQuoted) {
  EXPECT_THAT(run("pmvs2", fakes_ + " FAKE_FAIL=1").status, HasSubstr("ended with code 3: cannot do this"));
}

}  // namespace
}  // namespace carve
