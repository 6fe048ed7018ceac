#include <gmock/gmock.h>

#include <cmath>

#include "report/compare.h"
#include "report/table.h"

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

TEST(Compare, PairsRunsAndNamesWhatOnlyOneSideHas) {
  const std::string text = compare(overview(), {record("ant", "new", 1), record("zebra", "new", 1)},
                                   {record("ant", "new", 3), record("zebra", "new", 0, "stopped after 3 s")});
  EXPECT_THAT(text, HasSubstr("1 of 2 runs"));
  EXPECT_THAT(text, HasSubstr("zebra / new / seed 1: A done, B stopped after 3 s"));
  EXPECT_THAT(text, HasSubstr("1.000 → 3.000"));
}

}  // namespace
}  // namespace carve::experiments
