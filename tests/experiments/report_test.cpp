#include <gmock/gmock.h>

#include <cmath>

#include "carve/core/file.h"
#include "carve/surface/marching_cubes.h"
#include "report/compare.h"
#include "report/display_mesh.h"
#include "report/table.h"
#include "shapes.h"
#include "store/record.h"
#include "temporary_folder.h"

namespace carve::experiments {
namespace {
using testing::HasSubstr;

Record record(const std::string& model, const std::string& method, double error, const std::string& status = "done") {
  Record r;
  r.model = model;
  r.method = method;
  r.status = status;
  if (status == "done") r.metrics["error"] = error;
  return r;
}

Overview overview() {
  Overview o;
  o.title = "A title";
  o.baseline = "base";
  o.methods = {"base", "new"};
  o.models = {"zebra", "ant"};
  o.metrics = {{"error", "what it is", "%", Direction::lower}};
  return o;
}

TEST(Statistics, SignTestIsTheBinomialTail) {
  const std::vector<double> a = {0, 0, 0, 0, 5}, b = {1, 1, 1, 1, 1};
  const PairedDifference d = paired_difference(a, b);
  EXPECT_EQ(d.better, 4);
  EXPECT_EQ(d.worse, 1);
  EXPECT_NEAR(d.p, 2 * (1 + 5) / 32.0, 1e-12);
}

TEST(Statistics, AnIntervalHoldsItsMeanAndNoDifferenceIsNone) {
  for (unsigned seed = 1; seed < 9; ++seed) {
    std::vector<double> a, b;
    for (unsigned i = 0; i < 20; ++i) {
      a.push_back(std::sin(seed * 13.7 + i));
      b.push_back(std::cos(seed * 5.1 + i * i));
    }
    const PairedDifference d = paired_difference(a, b);
    EXPECT_LE(d.low, d.mean);
    EXPECT_GE(d.high, d.mean);
    EXPECT_FALSE(paired_difference(a, a).beyond_noise());
    std::vector<double> shifted = a;
    for (double& v : shifted) v += 1;
    EXPECT_TRUE(paired_difference(shifted, a).beyond_noise());
  }
}

TEST(Table, RowsFollowTheSpecTheBestIsBoldAFailureIsADashWithItsReason) {
  const Table table = make_table(overview(),
                                 {record("ant", "base", 2), record("ant", "new", 1), record("zebra", "base", 3),
                                  record("zebra", "new", 0, "crashed: Segmentation fault")},
                                 overview().metrics[0]);
  const std::string text = to_markdown(table);
  EXPECT_LT(text.find("| zebra"), text.find("| ant"));
  EXPECT_THAT(text, HasSubstr("| ant | 2.000 | **1.000** |"));
  EXPECT_THAT(text, HasSubstr("| zebra | **3.000** | – |"));
  EXPECT_THAT(text, HasSubstr("new: crashed: Segmentation fault (zebra)"));
  EXPECT_THAT(text, HasSubstr("what it is"));
  EXPECT_EQ(table.complete_rows, 1);
  EXPECT_THAT(to_latex(table), HasSubstr("\\textbf{1.000}"));
  EXPECT_THAT(to_csv(table), HasSubstr("zebra,3,\n"));
}

TEST(Table, MeansAreOverTheRowsThatEveryMethodHas) {
  const Table table =
      make_table(overview(), {record("ant", "base", 2), record("ant", "new", 1), record("zebra", "base", 100)},
                 overview().metrics[0]);
  EXPECT_EQ(table.summaries[0].mean, 2);
  EXPECT_EQ(table.summaries[1].mean, 1);
}

TEST(Summary, ARowAMethodAColumnAMetricWithTheChangeFromTheBaseline) {
  const TextTable table = summary(overview(), {record("ant", "base", 2), record("ant", "new", 1),
                                               record("zebra", "base", 4), record("zebra", "new", 2)});
  EXPECT_EQ(table.header, (std::vector<std::string>{"method", "error, % ↓"}));
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.rows[0][1].text, "3.000");
  EXPECT_EQ(table.rows[1][1].text, "1.500 (-50\u00a0%)");
  EXPECT_TRUE(table.rows[1][1].best);
  EXPECT_THAT(latex(table), HasSubstr("\\textbf{1.500 (-50~\\%)}"));
}

TEST(Table, AMethodThatNeverWorksLeavesTheOthersTheirMeans) {
  const Table table =
      make_table(overview(), {record("ant", "base", 2), record("ant", "new", 0, "crashed")}, overview().metrics[0]);
  EXPECT_EQ(table.complete_rows, 1);
  EXPECT_EQ(table.summaries[0].mean, 2);
}

TEST(Summary, TenTimesAndMoreIsAFactor) {
  const TextTable table = summary(overview(), {record("ant", "base", 2), record("ant", "new", 246)});
  EXPECT_EQ(table.rows[1][1].text, "246.0 (×\u00a0123)");
}

TEST(Results, EveryStageIsThoseThatAnyRunHad) {
  const TemporaryFolder folder;
  Overview all = overview();
  all.metrics = {{"error", "", "", Direction::lower},
                 {"seconds_known", "", "s", Direction::lower},
                 {"seconds_never", "", "s", Direction::lower},
                 {kEveryStage, "", "s", Direction::lower}};
  Record run = record("ant", "new", 1);
  run.metrics.insert({{"seconds_known", 1}, {"seconds_new", 2}});
  std::filesystem::create_directories(folder / "ant");
  write_file(folder / kOverviewFile, [&](std::ostream& out) { out << to_json(all); });
  write_file(folder / "ant" / kRecordFile, [&](std::ostream& out) { out << to_json(run); });
  std::vector<std::string> names;
  for (const RunMetric& metric : load_results(folder / "").overview.metrics) names.push_back(metric.name);
  EXPECT_THAT(names, testing::ElementsAre("error", "seconds_known", "seconds_new"));
}

TEST(DisplayMesh, AMeshIsPackedWithinItsTrianglesAndTheSameWayEveryTime) {
  const Shape shape = ball();
  VoxelGrid grid = grid_over(Vec3(-0.5, 0, -0.5), Vec3(0.5, 1, 0.5), 40);
  for (int z = 0; z < grid.size().z(); ++z)
    for (int y = 0; y < grid.size().y(); ++y)
      for (int x = 0; x < grid.size().x(); ++x) grid.set(x, y, z, shape.inside(grid.centre(x, y, z)));
  const Mesh mesh = marching_cubes(grid);
  const std::string all = packed(mesh, 100000), few = packed(mesh, 300);
  EXPECT_EQ(all, packed(mesh, 100000));
  EXPECT_LT(few.size(), all.size() / 3);
  EXPECT_LT(static_cast<double>(all.size()), 6.0 * static_cast<double>(mesh.triangles.size()));
  EXPECT_THROW(packed({}, 10), std::invalid_argument);
}

TEST(Compare, PairsRunsAndNamesWhatOnlyOneSideHas) {
  const std::string text = compare(overview(), {record("ant", "new", 1), record("zebra", "new", 1)},
                                   {record("ant", "new", 3), record("zebra", "new", 0, "stopped after 3 s")});
  EXPECT_THAT(text, HasSubstr("1 of 2 runs"));
  EXPECT_THAT(text, HasSubstr("zebra / new / seed 1: A done, B stopped after 3 s"));
  EXPECT_THAT(text, HasSubstr("1.000 → 3.000"));
  EXPECT_THAT(text, HasSubstr("too few runs to tell"));
}

}  // namespace
}  // namespace carve::experiments
