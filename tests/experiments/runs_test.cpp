#include <gmock/gmock.h>

#include <fstream>

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
  const TemporaryFolder folder_;
};

TEST_F(RunsTest, AFinishedSweepIsNotDoneAgainAndGivesTheSameTable) {
  write("s.toml", std::string("models = [\"box\", \"sphere\"]\nmetrics = [\"c2m_thesis\", \"f_score@1%\"]\n") + kQuick +
                      "sweep = { smooth.steps = [0, 2] }\n[[method]]\nname = \"a\"\n");
  EXPECT_THAT(experiments("run " + path("s.toml") + " -o " + path("one")).out, HasSubstr("4 done, 0 were there"));
  EXPECT_THAT(experiments("run " + path("s.toml") + " -o " + path("one")).out, HasSubstr("0 done, 4 were there"));
  EXPECT_THAT(experiments("run " + path("s.toml") + " -o " + path("two") + " --jobs 2 --shard 0/2").out,
              HasSubstr("2 done"));
  EXPECT_THAT(experiments("run " + path("s.toml") + " -o " + path("two") + " --jobs 2 --shard 1/2").out,
              HasSubstr("2 done"));
  EXPECT_THAT(table("one"), HasSubstr("sphere, smooth.steps=2"));
  EXPECT_EQ(table("one"), table("two"));
  EXPECT_EQ(read_file(path("one/s/tables/c2m_thesis.tex")), read_file(path("two/s/tables/c2m_thesis.tex")));
  EXPECT_THAT(experiments("status " + path("s.toml") + " -o " + path("one")).out, HasSubstr("4 of 4 runs done"));
}

TEST_F(RunsTest, ACrashAndAHangCostTheirCellsOnly) {
  write("s.toml", std::string("models = [\"box\"]\nmetrics = [\"c2m_thesis\"]\nlimits = { seconds = 20 }\n") + kQuick +
                      "[[method]]\nname = \"good\"\n[[method]]\nname = \"bad\"\narm = \"crash\"\n");
  EXPECT_EQ(experiments("run " + path("s.toml") + " -o " + path("r")).code, 1);
  EXPECT_THAT(table("r"), HasSubstr("| box | **"));
  write("s.toml", std::string("models = [\"box\"]\nmetrics = [\"c2m_thesis\"]\nlimits = { seconds = 1 }\n") + kQuick +
                      "[[method]]\nname = \"slow\"\narm = \"hang\"\n");
  EXPECT_EQ(experiments("run " + path("s.toml") + " -o " + path("h")).code, 1);
  EXPECT_THAT(table("h"), HasSubstr("slow: stopped after 1 s (box)"));
}

TEST_F(RunsTest, ASweepKilledTwiceEndsWithTheTableOfOneThatWasNot) {
  write("s.toml", std::string("models = [\"box\"]\nmetrics = [\"c2m_thesis\"]\n") + kQuick +
                      "sweep = { smooth.steps = [0, 1, 2, 3, 4, 5, 6, 7] }\n[[method]]\nname = \"a\"\n");
  for (const char* seconds : {"0.15", "0.4"})
    run_program(std::string("timeout -s KILL ") + seconds + " " CARVE_EXPERIMENTS_PROGRAM " run " + path("s.toml") +
                " -o " + path("killed"));
  EXPECT_EQ(experiments("run " + path("s.toml") + " -o " + path("killed")).code, 0);
  EXPECT_EQ(experiments("run " + path("s.toml") + " -o " + path("whole")).code, 0);
  EXPECT_EQ(table("killed"), table("whole"));
  for (const auto& entry : fs::recursive_directory_iterator(path("killed/s")))
    EXPECT_NE(entry.path().filename().string().front(), '.') << "left behind: " << entry.path();
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
