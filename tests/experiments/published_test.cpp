#include "report/published.h"

#include <gmock/gmock.h>

#include <fstream>

#include "carve/core/error.h"
#include "store/record.h"
#include "temporary_folder.h"

namespace carve::experiments {
namespace {
using testing::Contains;
using testing::HasSubstr;

class PublishedTest : public testing::Test {
 protected:
  void write(const std::filesystem::path& file, const std::string& text) const {
    std::filesystem::create_directories((folder_ / file).parent_path());
    std::ofstream(folder_ / file) << text;
  }
  void SetUp() override {
    for (const char* name : {"claims.csv", "table_4_1.csv", "table_4_2.csv", "table_4_3.csv", "table_b.csv"})
      std::filesystem::copy(std::filesystem::path(CARVE_PUBLISHED) / name, folder_ / name);
  }
  std::vector<PublishedTable> tables() const { return published_tables(folder_ / "", folder_ / "results"); }
  const TemporaryFolder folder_;
};

std::string row_of(const PublishedTable& table, const std::string& name) {
  for (const auto& row : table.table.rows)
    if (row[0].text == name) {
      std::string all;
      for (const TextTable::Entry& entry : row) all += entry.text + "|";
      return all;
    }
  return "no row " + name;
}

TEST_F(PublishedTest, TheContradictionsAreComputed) {
  const auto all = tables();
  ASSERT_EQ(all.size(), 3u);
  EXPECT_THAT(all[0].notes, Contains(HasSubstr("the table gives 13.9 %; the text says 5 % (abstract), 6 %")));
  EXPECT_THAT(all[1].notes,
              Contains(HasSubstr("dog, total: 20 % is printed, the printed times give 16.7 %, Appendix B 19.6 %")));
  EXPECT_THAT(all[1].notes,
              Contains(HasSubstr("dog, modeling from scratch: 2:55 is printed, Appendix B's mean is 3:07.5")));
  EXPECT_THAT(row_of(all[1], "xwing, modeling"), HasSubstr("2:45|2:45|1:40|1:39|40 %|39.4 %|40.0 %"));
}

TEST_F(PublishedTest, AChangedTableChangesWhatIsSaidOfIt) {
  write("table_4_1.csv", "method,error\nours,0.020\nCMVS,0.040\n");
  EXPECT_THAT(tables()[0].notes, Contains(HasSubstr("the table gives 50.0 %")));
  write("table_4_3.csv", "object,volume,mesh,texture,total\ncouch,1.00,2.00,3.00,7.00\naverage,1.00,2.00,3.00,7.00\n");
  EXPECT_THAT(tables()[2].notes, Contains("couch: the steps make 6.00, the total is given as 7.00"));
  write("table_4_3.csv", "object,volume\ncouch,1.00,2.00\n");
  EXPECT_THROW(tables(), IoError);
}

TEST_F(PublishedTest, MeasuredTimesStandBesidePublishedOnes) {
  Overview overview;
  overview.spec = "times";
  overview.published = {"table_4_3", "ours", {{"volume", "step_volume"}, {"total", "seconds"}}};
  overview.runs = {"times/couch"};
  write("results/times/overview.json", to_json(overview));
  Record record;
  record.model = "couch", record.method = "ours", record.status = "done";
  record.metrics = {{"step_volume", 0.186}, {"seconds", 0.5}};
  write("results/times/couch/run.json", to_json(record));
  const PublishedTable table = tables()[2];
  EXPECT_THAT(row_of(table, "couch"), HasSubstr("1.86|0.1860|10 ×|"));
  EXPECT_THAT(row_of(table, "couch"), HasSubstr("634.01|–|–|"));  // of other steps: no ratio
  EXPECT_THAT(row_of(table, "wagon"), HasSubstr("1.90|–|–|"));
}

}  // namespace
}  // namespace carve::experiments
