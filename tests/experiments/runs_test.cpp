#include <gmock/gmock.h>

#include <fstream>
#include <map>
#include <sstream>

#include "program.h"

// Sweeps through the program itself: what crashes, hangs or is killed.

namespace carve {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* kQuick =
    "options = { grid = 16, synthesize = { size = 64, samples = 1 }, evaluate = { samples = 500, iou_resolution = 16 } "
    "}\n";

class RunsTest : public testing::Test {
 protected:
  Outcome experiments(const std::string& arguments) const {
    return run_program(CARVE_EXPERIMENTS_PROGRAM " " + arguments);
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
  std::string table(const std::string& results) const { return experiments("table -o " + path(results)).out; }
  // Every table a folder of results has, by name, without what is timing.
  std::map<std::string, std::string> tables(const std::string& results) const {
    experiments("table -o " + path(results));
    std::map<std::string, std::string> texts;
    for (const auto& entry : fs::recursive_directory_iterator(path(results)))
      if (entry.path().parent_path().filename() == "tables") {
        std::istringstream lines(read_file(entry.path()));
        std::string& text = texts[entry.path().filename().string()];
        for (std::string line; std::getline(lines, line);)
          if (!HasTiming(line)) text += line + "\n";
      }
    return texts;
  }
  static bool HasTiming(const std::string& line) {  // rows of runs.csv
    for (const char* timing : {",seconds", ",cpu_seconds", ",step_", ",megabytes"})
      if (line.find(timing) != std::string::npos) return true;
    return false;
  }
  // Every mesh below a folder by its run.
  std::map<std::string, std::string> meshes(const std::string& results) const {
    std::map<std::string, std::string> bytes;
    for (const auto& entry : fs::recursive_directory_iterator(path(results)))
      if (entry.path().filename() == "mesh.ply" || entry.path().filename() == "mesh.glb")
        bytes[fs::relative(entry.path(), path(results)).string()] = read_file(entry.path());
    return bytes;
  }
  const TemporaryFolder folder_;
};

TEST_F(RunsTest, AFinishedSweepIsNotDoneAgainAndAnotherGivesTheSameBytes) {
  write("s.toml", std::string("models = [\"box\", \"sphere\"]\nmetrics = [\"c2m_thesis\", \"f_score@1%\"]\n") + kQuick +
                      "sweep = { smooth.steps = [0, 2] }\n[[method]]\nname = \"a\"\n");
  EXPECT_THAT(experiments("run " + path("s.toml") + " -o " + path("one")).out, HasSubstr("4 done, 0 were there"));
  EXPECT_THAT(experiments("run " + path("s.toml") + " -o " + path("one")).out, HasSubstr("0 done, 4 were there"));
  EXPECT_THAT(experiments("run " + path("s.toml") + " -o " + path("two") + " --jobs 2 --shard 0/2").out,
              HasSubstr("2 done"));
  EXPECT_THAT(experiments("run " + path("s.toml") + " -o " + path("two") + " --jobs 2 --shard 1/2").out,
              HasSubstr("2 done"));
  EXPECT_THAT(table("one"), HasSubstr("sphere, smooth.steps=2"));
  EXPECT_EQ(tables("one").size(), 9u);  // two metrics and the summary in three formats each, runs.csv
  EXPECT_EQ(tables("one"), tables("two"));
  EXPECT_EQ(meshes("one").size(), 8u);
  EXPECT_EQ(meshes("one"), meshes("two"));
  EXPECT_THAT(experiments("status " + path("s.toml") + " -o " + path("one")).out, HasSubstr("4 of 4 runs done"));
}

TEST_F(RunsTest, ACrashAHangAndTooMuchMemoryCostTheirCellsOnly) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "runs have no limit on memory under the address sanitizer";
#endif
  write("s.toml", std::string("models = [\"box\"]\nmetrics = [\"c2m_thesis\"]\n"
                              "limits = { seconds = 15, megabytes = 2000 }\n") +
                      kQuick +
                      "[[method]]\nname = \"good\"\n[[method]]\nname = \"bad\"\narm = \"crash\"\n"
                      "[[method]]\nname = \"slow\"\narm = \"hang\"\n[[method]]\nname = \"large\"\narm = \"hoard\"\n");
  EXPECT_EQ(experiments("run " + path("s.toml") + " -o " + path("r") + " --jobs 4").code, 1);
  for (const char* method : {"good", "bad", "slow", "large"})  // also of what failed it is known what ran
    for (const char* key : {"commit", "dirty", "compiler", "flags", "libraries", "cpu", "date"})
      EXPECT_THAT(read_file(folder_ / "r/s/box" / method / "seed=1/run.json"),
                  HasSubstr(std::string("\"") + key + "\": \""))
          << method;
  const std::string text = table("r");
  EXPECT_THAT(text, testing::ContainsRegex("box \\| \\*\\*[0-9.]+\\*\\* \\| – \\| – \\| – \\|"));
  EXPECT_THAT(text, HasSubstr("bad: crashed: "));
  EXPECT_THAT(text, HasSubstr("slow: stopped after 15 s (box)"));
  EXPECT_THAT(text, HasSubstr("large: carve-experiments: not enough memory"));
}

TEST_F(RunsTest, BadUsageIsOneLine) {
  write("s.toml", "models = [\"nothing_like_it\"]\n[[method]]\nname = \"a\"\n");
  for (const char* arguments : {"plan", "plan /no/such.toml", "run --shard 3/2 ", "frobnicate"}) {
    const std::string spec = std::string(arguments).starts_with("run") ? path("s.toml") : "";
    const Outcome outcome = experiments(arguments + spec);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
  EXPECT_THAT(experiments("plan " + path("s.toml")).err, HasSubstr("there is no nothing_like_it"));
}

}  // namespace
}  // namespace carve
