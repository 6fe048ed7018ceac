#include <gmock/gmock.h>

#include <cmath>
#include <sstream>

#include "carve/core/file.h"
#include "carve/surface/marching_cubes.h"
#include "report/compare.h"
#include "report/display_mesh.h"
#include "report/front.h"
#include "report/plot.h"
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

// Results on disk as a spec "s" leaves them, read back.
Results stored(const TemporaryFolder& folder, Overview overview, const std::vector<Record>& records) {
  for (const Record& r : records) {
    overview.runs.push_back("s/" + r.model + "/" + r.method + "/run " + text_of(r.swept));
    std::filesystem::create_directories(folder / overview.runs.back());
    write_file(folder / overview.runs.back() / kRecordFile, [&](std::ostream& out) { out << to_json(r); });
  }
  write_file(folder / "s" / kOverviewFile, [&](std::ostream& out) { out << to_json(overview); });
  return load_results(folder / "s");
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

TEST(Statistics, FewPairsThatDisagreeAreNoiseWhateverTheirInterval) {
  const std::vector<double> a = {3, 2, 4, 3, 2, -0.1}, agree = {3, 2, 4, 3, 2, 0.1}, zero(6, 0.0);
  const PairedDifference d = paired_difference(a, zero);
  EXPECT_GT(d.low, 0);
  EXPECT_FALSE(d.beyond_noise());
  EXPECT_TRUE(paired_difference(agree, zero).beyond_noise());
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

// A table of so many methods and models; errors differ from cell to cell, the last method of the first model failed.
Table table_of(int methods, int models) {
  Overview o = overview();
  o.methods = o.models = {};
  std::vector<Record> records;
  for (int c = 0; c < methods; ++c) o.methods.push_back("method number " + std::to_string(c));
  o.baseline = o.methods[0];
  for (int r = 0; r < models; ++r) {
    o.models.push_back("model" + std::to_string(r));
    for (int c = 0; c < methods; ++c)
      records.push_back(record(o.models.back(), o.methods[c], 10 + (7 * r + 5 * c) % 11,
                               r == 0 && c == methods - 1 ? "crashed: Aborted" : "done"));
  }
  return make_table(o, records, o.metrics[0]);
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++found;
  return found;
}

std::size_t widest_line(const std::string& markdown) {
  std::size_t widest = 0;
  std::istringstream lines(markdown);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("| m")) widest = std::max(widest, line.size());
  return widest;
}

TEST(Table, ATableTooWideForAPageHasItsMethodsAsRowsInEveryFormat) {
  const Table narrow = table_of(4, 5), wide = table_of(21, 4);
  EXPECT_THAT(to_markdown(narrow), HasSubstr("|  | method number 0 | method number 1 |"));
  const std::string text = to_markdown(wide), page = to_html(wide), paper = to_latex(wide);
  EXPECT_THAT(text, HasSubstr("|  | model0 | model1 | model2 | model3 | mean of 3 | median of 3 |"));
  EXPECT_THAT(text, HasSubstr("| method number 20 | – | "));
  EXPECT_THAT(text, HasSubstr("–: method number 20: crashed: Aborted (model0)"));
  EXPECT_THAT(text, HasSubstr("method number 1 − method number 0: "));
  EXPECT_EQ(count(page, "<th>"), 7u);
  EXPECT_EQ(count(page, "<tr>"), 1u + 21u);
  EXPECT_EQ(count(paper, "\\\n"), 1u + 21u);
  EXPECT_THAT(to_csv(wide), testing::StartsWith("row,method number 0,"));  // data: a row a model, as ever
}

TEST(Table, NoEntryIsLostAndTheSameAreBestHoweverATableIsLaidOut) {
  for (const auto& [methods, models] : {std::pair(3, 4), std::pair(21, 4), std::pair(21, 60), std::pair(4, 60)}) {
    const Table table = table_of(methods, models);
    const std::string text = to_markdown(table), page = to_html(table), paper = to_latex(table);
    EXPECT_LT(widest_line(text), 160u) << methods << " x " << models;
    EXPECT_EQ(count(page, "<td class=\"best\">"), count(paper, "\\textbf{"));
    EXPECT_EQ(count(page, "<td class=\"best\">"), (count(text, "**") - 2) / 2);  // the title is bold too
    std::size_t best = 0;
    for (int row = 0; row < models; ++row) {
      double least = INFINITY;
      for (const Table::Entry& entry : table.rows[row].entries) least = std::min(least, entry.value.value_or(INFINITY));
      for (const Table::Entry& entry : table.rows[row].entries) best += entry.value == least;
      EXPECT_GE(count(page, ">model" + std::to_string(row) + "<"), 1u);
    }
    EXPECT_GE(count(page, "<td class=\"best\">"), best + 2);  // and of means and medians
    EXPECT_EQ(count(page, "<td>–</td>"), 1u);
  }
}

TEST(TextTable, WhatAFormatTakesForItsOwnIsWrittenAsText) {
  const TextTable table{{"a|b", "x^2~{%}"}, {{{"c|d"}, {"1 < 2"}}}};
  EXPECT_THAT(markdown(table), HasSubstr("| a\\|b | x^2~{%} |"));
  EXPECT_THAT(latex(table), HasSubstr("x\\^{}2\\~{}\\{\\%\\}"));
  EXPECT_THAT(latex(table), HasSubstr("1 $<$ 2"));
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
  std::vector<std::string> names;
  for (const RunMetric& metric : stored(folder, all, {run}).overview.metrics) names.push_back(metric.name);
  EXPECT_THAT(names, testing::ElementsAre("error", "seconds_known", "seconds_new"));
}

TEST(Results, ARunThatStatesASweptFieldStandsInEveryRowOfIt) {
  const TemporaryFolder folder;
  Overview swept = overview();
  swept.sweep = {"grid", "steps"};
  std::vector<Record> records;
  for (const char* steps : {"0", "1"}) {
    records.push_back(record("ant", "base", 5));
    records.back().swept = {{"steps", steps}};
    for (const char* grid : {"32", "64", "128"}) {
      records.push_back(record("ant", "new", 7));
      records.back().swept = {{"grid", grid}, {"steps", steps}};
    }
  }
  const Results found = stored(folder, swept, records);
  EXPECT_EQ(found.records.size(), 8u);  // what ran is counted once
  EXPECT_EQ(found.rows.size(), 12u);
  const Table table = make_table(found.overview, found.rows, found.overview.metrics[0]);
  EXPECT_EQ(table.rows.size(), 6u);
  EXPECT_EQ(table.complete_rows, 6);
  for (const Table::Row& row : table.rows) EXPECT_EQ(row.entries[0].value, 5) << row.label;
}

TEST(Results, WhatTheSpecNoLongerHasIsLeftOutAndSaid) {
  const TemporaryFolder folder;
  const Results all = stored(folder, overview(), {record("ant", "base", 1), record("ant", "old", 9)});
  EXPECT_EQ(all.records.size(), 2u);
  Overview shorter = all.overview;
  shorter.runs = {all.records[0].folder};
  write_file(folder / "s" / kOverviewFile, [&](std::ostream& out) { out << to_json(shorter); });
  const Results some = load_results(folder / "s");
  ASSERT_EQ(some.records.size(), 1u);
  EXPECT_EQ(some.records[0].folder, shorter.runs[0]);
  EXPECT_THAT(some.complaints, testing::ElementsAre(HasSubstr("1 runs left out")));
}

TEST(Results, ThroughALinkAreTheSame) {
  const TemporaryFolder folder;
  stored(folder, overview(), {record("ant", "base", 1), record("ant", "new", 2)});
  std::filesystem::create_directories(folder / "elsewhere");
  std::filesystem::create_directory_symlink(folder / "s", folder / "elsewhere/s");
  EXPECT_EQ(load_results(folder / "elsewhere/s").records.size(), 2u);
}

TEST(Front, WhatMakesTheThesisAgainComesFirstInItsOrder) {
  const TemporaryFolder folder;
  for (const auto& [name, thesis] : {std::pair<std::string, std::vector<std::string>>{"a_more", {}},
                                     {"b_late", {"Fig. 4.10", "Fig. 4.9"}},
                                     {"c_early", {"Fig. 4.2"}},
                                     {"d_table", {"Table 4.3"}}}) {
    Overview o = overview();
    o.thesis = thesis;
    std::filesystem::create_directories(folder / name);
    write_file(folder / name / kOverviewFile, [&](std::ostream& out) { out << to_json(o); });
  }
  std::vector<std::string> names;
  for (const auto& [name, found] : load_all(folder / "")) names.push_back(name);
  EXPECT_THAT(names, testing::ElementsAre("d_table", "c_early", "b_late", "a_more"));
}

TEST(Plot, OfVeryManyModelsDrawsHowDifferencesSpread) {
  const TemporaryFolder folder;
  Overview o = overview();
  o.models.clear();
  std::vector<Record> records;
  for (int i = 0; i < 40; ++i) {
    o.models.push_back("model" + std::to_string(i));
    records.push_back(record(o.models.back(), "base", i));
    records.push_back(record(o.models.back(), "new", i + i % 7));
  }
  plot(folder / "plots", "error", o, records, o.metrics[0]);
  EXPECT_THAT(read_file(folder / "plots/error.gnuplot"), HasSubstr("(column(3) - column(2))"));
  EXPECT_GT(std::filesystem::file_size(folder / "plots/error.svg"), 1000u);
  EXPECT_THAT(read_file(folder / "plots/error.csv"), HasSubstr("model39,39,43"));  // every value is there
}

TEST(Front, RunsAreCountedByHowTheyEndedAndTheThesisIsInItsOrder) {
  const TemporaryFolder folder;
  Overview with = overview();
  with.thesis = {"Fig. 4.10", "Fig. 4.9", "Table 4.3"};
  Record good = record("ant", "base", 1);
  good.provenance = {{"commit", "0123456789abcdef"}, {"dirty", "yes"}, {"cpu", "a fast one"}, {"date", "2000-01-01"}};
  Results found = stored(folder, with,
                         {good, record("ant", "new", 0, "crashed: Aborted"),
                          record("zebra", "new", 0, std::string(kNotInstalled) + ": colmap")});
  found.overview.runs.emplace_back("one more");
  const Front front = front_of({{"s", found}}, {{"Table 4.3: seconds", {}, {}}});
  EXPECT_EQ(front.lines[0],
            "1 experiment, 1 of 4 runs have a result, 1 failed, 1 need what is not installed, 1 are not run yet.");
  EXPECT_THAT(front.lines[1], HasSubstr("commit 0123456789 and changes not committed"));
  EXPECT_THAT(front.lines[2], HasSubstr("a fast one"));
  std::vector<std::string> thesis;
  for (const Front::Place& place : front.thesis) thesis.push_back(place.what);
  EXPECT_THAT(thesis, testing::ElementsAre("Table 4.3", "Fig. 4.9", "Fig. 4.10"));
  EXPECT_THAT(front.thesis[0].anchors, testing::ElementsAre("table-4-3", "s"));
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
