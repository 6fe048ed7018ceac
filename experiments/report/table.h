#pragma once
#include <optional>
#include <string>
#include <vector>

#include "report/statistics.h"
#include "report/text_table.h"
#include "store/record.h"

namespace carve::experiments {

/// One metric over a spec's runs: a row a model and swept values, a column a method, seeds averaged.
struct Table {
  struct Entry {
    std::optional<double> value;  // mean over the seeds
    std::string why;              // there is none
  };
  struct Row {
    std::string label;
    std::vector<Entry> entries;
  };
  struct Summary {                                // of one column
    double mean = 0, median = 0;                  // over the rows that every method has
    std::optional<PairedDifference> to_baseline;  // of those rows
  };
  RunMetric metric;
  std::string title, baseline;
  std::vector<std::string> columns;
  std::vector<Row> rows;
  std::vector<Summary> summaries;
  int complete_rows = 0;  // rows that every method has
};

Table make_table(const Overview& overview, const std::vector<Record>& records, const RunMetric& metric);

/// Best entry of a row in bold, missing ones as a dash with the reason below the table, the metric's definition above
/// it.
std::string to_markdown(const Table& table);
std::string to_html(const Table& table);  // the same without the definition, for html_report
std::string to_csv(const Table& table);
std::string to_latex(const Table& table);     // booktabs
std::string legend(const RunMetric& metric);  // name (unit): formula; which is better

/// The table of an ablation: a row a method, a column a metric, means over the rows that every method has, the best of
/// a column in bold; behind them in brackets the change from the baseline in %.
TextTable summary(const Overview& overview, const std::vector<Record>& records);

/// Every run and metric in one long table: spec, model, method, swept fields, seed, status, metric, value.
std::string long_csv(const std::vector<Record>& records);

}  // namespace carve::experiments
