#include "run/spec.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <set>

#include "run/models.h"
#include "run/plan.h"
#include "temporary_folder.h"

namespace carve::experiments {
namespace {

class SpecTest : public testing::Test {
 protected:
  std::string error_of(const std::string& text) const {
    try {
      read(text);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "no error";
  }
  Spec read(const std::string& text) const {
    std::ofstream(folder_ / "x.toml") << text;
    return read_spec(folder_ / "x.toml");
  }
  const TemporaryFolder folder_;
};

constexpr const char* kGood = R"(
models = ["box", "stairs_*"]
metrics = ["c2m_thesis", "seconds"]
seeds = [1, 2]
options = { grid = 32 }
sweep = { grid = [16, 32], smooth.steps = [0, 1, 2] }
[[method]]
name = "plain"
[[method]]
name = "rough"
options = { smooth = { level = 10 } }
)";

TEST_F(SpecTest, APlanIsEveryCombination) {
  const Spec spec = read(kGood);
  const std::vector<Cell> cells = plan(spec);
  std::set<std::string> models;
  std::set<std::filesystem::path> paths;
  std::set<std::string> ids;
  for (const Cell& cell : cells) {
    models.insert(cell.model);
    paths.insert(cell.path);
    ids.insert(cell.id);
  }
  EXPECT_GT(models.size(), 2u);
  EXPECT_EQ(cells.size(), models.size() * 2 * 3 * 2 * 2);
  EXPECT_EQ(paths.size(), cells.size());
  EXPECT_EQ(ids.size(), cells.size());
}

TEST_F(SpecTest, SweptValuesWinOverTheSpecs) {
  for (const Cell& cell : plan(read(kGood))) EXPECT_EQ(cell.settings.at("grid"), cell.swept.at("grid"));
}

TEST_F(SpecTest, AMethodThatStatesASweptFieldIsRunOnceForIt) {
  const Spec spec = read(
      "models = [\"box\", \"sphere\"]\nseeds = [1, 2]\nsweep = { grid = [16, 32, 64], smooth.steps = [0, 1] }\n"
      "[[method]]\nname = \"follows\"\n[[method]]\nname = \"states\"\noptions = { grid = 24 }\n");
  std::map<std::string, int> runs;
  std::set<std::filesystem::path> paths;
  for (const Cell& cell : plan(spec)) {
    ++runs[cell.method];
    paths.insert(cell.path);
    EXPECT_EQ(cell.swept.contains("grid"), cell.method == "follows");
    EXPECT_EQ(cell.settings.at("grid"), cell.method == "follows" ? cell.swept.at("grid") : "24");
    EXPECT_EQ(cell.settings.at("smooth.steps"), cell.swept.at("smooth.steps"));
  }
  EXPECT_EQ(runs, (std::map<std::string, int>{{"follows", 2 * 2 * 3 * 2}, {"states", 2 * 2 * 2}}));
  EXPECT_EQ(paths.size(), plan(spec).size());
}

TEST_F(SpecTest, SweptNumbersAreWrittenAsInTheSpec) {
  const std::vector<Cell> cells =
      plan(read("models = [\"box\"]\nsweep = { convex.grown = [0.2] }\n"
                "[[method]]\nname = \"a\"\n"));
  ASSERT_EQ(cells.size(), 1u);
  EXPECT_EQ(cells[0].swept.at("convex.grown"), "0.2");
}

TEST_F(SpecTest, ShardsAreThePlan) {
  const std::vector<Cell> cells = plan(read(kGood));
  std::multiset<std::string> whole, parts;
  for (const Cell& cell : cells) whole.insert(cell.id);
  for (int i = 0; i < 3; ++i)
    for (const Cell& cell : shard(cells, i, 3)) parts.insert(cell.id);
  EXPECT_EQ(parts, whole);
}

TEST_F(SpecTest, AllMinusSwitchesOneFieldOff) {
  const Spec spec = read("models = [\"box\"]\nall_minus = [\"intersections\", \"smooth.steps\"]\n");
  ASSERT_EQ(spec.methods.size(), 3u);
  EXPECT_EQ(spec.methods[0].settings, Settings{});
  EXPECT_EQ(spec.methods[1].settings, (Settings{{"intersections", "off"}}));
  EXPECT_EQ(spec.methods[2].settings, (Settings{{"smooth.steps", "0"}}));
}

TEST_F(SpecTest, ErrorsNameFileAndLine) {
  const std::string good = "models = [\"box\"]\n[[method]]\nname = \"a\"\n";
  EXPECT_THAT(error_of("modles = []\n" + good), testing::HasSubstr("x.toml:1: unknown key modles"));
  EXPECT_THAT(error_of("options = { grid = 5 }\n" + good), testing::HasSubstr("x.toml:1: grid must be"));
  EXPECT_THAT(error_of("\nsweep = { grid = [16, 5000] }\n" + good), testing::HasSubstr("x.toml:2: grid must be"));
  EXPECT_THAT(error_of("metrics = [\"beauty\"]\n" + good), testing::HasSubstr("x.toml:1: unknown metric beauty"));
  EXPECT_THAT(error_of(good + "options = { gird = 7 }\n"), testing::HasSubstr("x.toml:4: unknown option gird"));
  EXPECT_THAT(error_of(good + "arm = \"magic\"\n"), testing::HasSubstr("unknown arm magic"));
  EXPECT_THAT(error_of(good + "[[method]]\nname = \"a\"\n"), testing::HasSubstr("x.toml:4: method a is there twice"));
  EXPECT_THAT(error_of("baseline = \"b\"\n" + good), testing::HasSubstr("baseline b"));
  EXPECT_THAT(error_of("\nmodels = [\n\"box\",\n\"bxo\"]\n"), testing::HasSubstr("x.toml:4: models: there is no bxo"));
  EXPECT_THAT(error_of("models = [\"bx*\"]\n"), testing::HasSubstr("x.toml:1: models: there is no bx*"));
  EXPECT_THAT(error_of("renders = [\"bxo\"]\n" + good), testing::HasSubstr("x.toml:1: models: there is no bxo"));
  EXPECT_THAT(error_of("heat_map = { models = [\"bxo\"] }\n" + good), testing::HasSubstr("x.toml:1: models: there is"));
  EXPECT_THAT(error_of("sweep = { grid = [] }\n" + good), testing::HasSubstr("x.toml:1: grid needs a value"));
  for (const char* twice : {"seeds = [1, 1]\n", "sweep = { grid = [16, 16] }\n", "metrics = [\"iou\", \"iou\"]\n"})
    EXPECT_THAT(error_of(twice + good), testing::HasSubstr("x.toml:1: is there twice"));
  EXPECT_THAT(error_of("seeds = [-1]\n" + good), testing::HasSubstr("a seed must be in [0, 4294967295]"));
  EXPECT_THAT(error_of("thesis = [\"Figure 4.2\"]\n" + good), testing::HasSubstr("x.toml:1: thesis must name"));
  EXPECT_THAT(error_of("\nsweep = { grid = [16, 32] }\n" + good + "options = { grid = 8 }\n"),
              testing::HasSubstr("x.toml:2: every method states grid itself"));
  EXPECT_THAT(error_of("models = [\"box\"\n"), testing::HasSubstr("x.toml:"));
  EXPECT_THAT(error_of("models = [\"box\"]\n"), testing::HasSubstr("at least one [[method]]"));
}

TEST_F(SpecTest, WhatIsHeldOutIsInNoOtherSetAndNoOtherGlob) {
  const auto add = [&](const char* variable, const std::string& group, const std::string& name) {
    std::filesystem::create_directories(folder_ / group / name);
    std::ofstream(folder_ / group / name / (name + ".obj")) << "v 0 0 0\n";
    setenv(variable, (folder_ / group).c_str(), 1);
  };
  add("CARVE_ARTIST_MODELS", "artist", "known");
  add("CARVE_HELD_OUT_MODELS", "held_out", "unseen");
  const std::vector<std::string> known = {"artist/known"}, unseen = {"held_out/unseen"};
  EXPECT_EQ(expand_subjects({"set:artist"}), known);
  EXPECT_EQ(expand_subjects({"artist/*"}), known);
  EXPECT_EQ(expand_subjects({"set:held_out"}), unseen);
  EXPECT_EQ(expand_subjects({"held_out/*"}), unseen);
  EXPECT_EQ(expand_subjects({"held_out/unseen"}), unseen);
  for (const char* pattern : {"*", "*/unseen", "set:thesis", "set:procedural", "set:drawing"})
    EXPECT_THAT(expand_subjects({pattern}), testing::Not(testing::Contains("held_out/unseen"))) << pattern;
  EXPECT_THAT(expand_subjects({"*"}), testing::Contains("artist/known"));
  unsetenv("CARVE_ARTIST_MODELS");
  unsetenv("CARVE_HELD_OUT_MODELS");
}

TEST_F(SpecTest, EverySpecOfTheProjectIsReadAndPlanned) {
  int specs = 0;
  for (const auto& entry : std::filesystem::directory_iterator(CARVE_SPECS)) {
    const Spec spec = read_spec(entry.path());
    // The hand-made drawings and the artists' models are made by experiments/reproduce: not every machine has them.
    const bool optional = spec.models == std::vector<std::string>{"set:drawing"} ||
                          spec.models == std::vector<std::string>{"set:held_out"};
    EXPECT_EQ(plan(spec).empty() && !optional, false) << entry.path();
    ++specs;
  }
  EXPECT_GT(specs, 0);
}

}  // namespace
}  // namespace carve::experiments
