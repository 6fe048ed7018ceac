#include "report/table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <sstream>

#include "eval/report.h"

namespace carve::experiments {
namespace {

std::string row_label(const Record& record) {
  return record.swept.empty() ? record.model : record.model + ", " + text_of(record.swept);
}

// Rows in the order of models, then of the swept values with numbers in numeric order.
std::vector<const Record*> sorted_by_row(const Overview& overview, const std::vector<Record>& records) {
  const auto place = [&](const std::string& model) {
    return std::find(overview.models.begin(), overview.models.end(), model) - overview.models.begin();
  };
  const auto number = [](const std::string& text) {
    double value = 0;
    const bool is = std::from_chars(text.data(), text.data() + text.size(), value).ptr == text.data() + text.size();
    return std::pair(!is, value);
  };
  std::vector<const Record*> sorted;
  for (const Record& record : records) sorted.push_back(&record);
  std::stable_sort(sorted.begin(), sorted.end(), [&](const Record* a, const Record* b) {
    if (place(a->model) != place(b->model)) return place(a->model) < place(b->model);
    for (const std::string& field : overview.sweep) {
      const std::string x = a->swept.contains(field) ? a->swept.at(field) : "",
                        y = b->swept.contains(field) ? b->swept.at(field) : "";
      if (x != y) return std::pair(number(x), x) < std::pair(number(y), y);
    }
    return false;
  });
  return sorted;
}

template <class Label>
std::vector<std::string> labels_of(const std::vector<const Record*>& records, Label&& label_of) {
  std::vector<std::string> labels;
  for (const Record* record : records)
    if (const std::string label = label_of(*record); std::find(labels.begin(), labels.end(), label) == labels.end())
      labels.push_back(label);
  return labels;
}

// The combinations of swept values that there are, as text.
std::vector<std::string> swept_values(const Overview& overview, const std::vector<Record>& records) {
  Overview any_model = overview;
  any_model.models.clear();
  return labels_of(sorted_by_row(any_model, records), [](const Record& r) { return text_of(r.swept); });
}

Table::Entry entry_of(const std::vector<Record>& records, const std::string& row, const std::string& method,
                      const std::string& metric) {
  Table::Entry entry;
  std::vector<double> values;
  for (const Record& record : records) {
    if (record.method != method || row_label(record) != row) continue;
    if (!record.done())
      entry.why = record.status;
    else if (const auto found = record.metrics.find(metric); found != record.metrics.end())
      values.push_back(found->second);
    else
      entry.why = "has no " + metric;
  }
  if (entry.why.empty() && values.empty()) entry.why = "not run";
  if (entry.why.empty()) entry.value = mean(values);  // a mean over some of the seeds would flatter
  return entry;
}

// Means are over the rows of all methods that have any result: one that never works must not cost the others theirs.
void summarise(Table& table) {
  std::vector<std::vector<double>> columns(table.columns.size());
  std::vector<bool> works(columns.size(), false);
  for (const Table::Row& row : table.rows)
    for (std::size_t c = 0; c < columns.size(); ++c) works[c] = works[c] || row.entries[c].value;
  for (const Table::Row& row : table.rows) {
    bool complete = !row.entries.empty();
    for (std::size_t c = 0; c < columns.size(); ++c) complete = complete && (row.entries[c].value || !works[c]);
    if (!complete || std::none_of(works.begin(), works.end(), [](bool any) { return any; })) continue;
    ++table.complete_rows;
    for (std::size_t c = 0; c < columns.size(); ++c)
      if (works[c]) columns[c].push_back(*row.entries[c].value);
  }
  const auto base = std::find(table.columns.begin(), table.columns.end(), table.baseline) - table.columns.begin();
  for (std::size_t c = 0; c < columns.size(); ++c) {
    Table::Summary summary{mean(columns[c]), median(columns[c]), std::nullopt};
    if (base < static_cast<std::ptrdiff_t>(columns.size()) && base != static_cast<std::ptrdiff_t>(c))
      summary.to_baseline = paired_difference(columns[c], columns[base]);
    table.summaries.push_back(summary);
  }
}

// Index of a row's best entries.
std::set<std::size_t> best_of(const Table& table, const Table::Row& row) {
  std::set<std::size_t> best;
  if (table.metric.better == Direction::none || row.entries.size() < 2) return best;
  double record = 0;
  for (std::size_t c = 0; c < row.entries.size(); ++c) {
    if (!row.entries[c].value || !std::isfinite(*row.entries[c].value)) continue;
    const double value = table.metric.better == Direction::lower ? *row.entries[c].value : -*row.entries[c].value;
    if (best.empty() || value < record) best.clear();
    if (best.empty() || value == record) best.insert(c), record = value;
  }
  return best;
}

std::string difference_text(const PairedDifference& d, Direction better) {
  const int wins = better == Direction::higher ? d.worse : d.better,
            losses = better == Direction::higher ? d.better : d.worse;
  return short_text(d.mean) + " [" + short_text(d.low) + ", " + short_text(d.high) + "], " + std::to_string(wins) +
         " better, " + std::to_string(losses) + " worse, p = " + short_text(d.p);
}

// Differences from the baseline, and why entries are missing.
std::vector<std::string> notes_of(const Table& table) {
  std::vector<std::string> notes;
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (const auto& d = table.summaries[c].to_baseline; d && d->pairs > 0)
      notes.push_back(table.columns[c] + " − " + table.baseline + ": " + difference_text(*d, table.metric.better));
  std::vector<std::pair<std::string, std::vector<std::string>>> missing;  // column and reason, rows
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    for (const Table::Row& row : table.rows) {
      if (row.entries[c].value) continue;
      const std::string key = table.columns[c] + ": " + row.entries[c].why;
      if (missing.empty() || missing.back().first != key) missing.push_back({key, {}});
      missing.back().second.push_back(row.label);
    }
  constexpr std::size_t kNamed = 4;
  for (auto& [key, rows] : missing) {
    const std::size_t more = rows.size() - std::min(rows.size(), kNamed);
    rows.resize(rows.size() - more);
    notes.push_back("–: " + key + " (" + joined(rows, "; ") + (more ? " and " + std::to_string(more) + " more" : "") +
                    ")");
  }
  return notes;
}

// " (+12 %)", or " (× 123)" from ten times on; nothing where a share means nothing.
std::string change_text(double value, double base) {
  if (!std::isfinite(value) || !std::isfinite(base) || base == 0) return "";
  const double percent = 100 * (value / base - 1);
  char text[32];
  if (percent >= 900) {
    std::snprintf(text, sizeof text, " (×\u00a0%.0f)", value / base);
    return text;
  }
  if (std::abs(percent) < 0.05) return " (0.0\u00a0%)";  // not "-0.0"
  std::snprintf(text, sizeof text, std::abs(percent) < 9.95 ? " (%+.1f\u00a0%%)" : " (%+.0f\u00a0%%)", percent);
  return text;
}

// Means of a table's columns and their changes from the baseline's.
std::vector<TextTable::Entry> summary_column(const Table& table) {
  Table::Row means{"", {}};
  for (const Table::Summary& column : table.summaries) means.entries.push_back({column.mean, ""});
  const std::set<std::size_t> best = best_of(table, means);
  const auto base = std::find(table.columns.begin(), table.columns.end(), table.baseline) - table.columns.begin();
  std::vector<TextTable::Entry> column;
  for (std::size_t m = 0; m < table.columns.size(); ++m) {
    const double value = table.summaries[m].mean;
    std::string entry = std::isfinite(value) ? short_text(value) : "–";
    if (base < std::ssize(table.columns) && base != static_cast<std::ptrdiff_t>(m))
      entry += change_text(value, table.summaries[base].mean);
    column.push_back({entry, best.contains(m)});
  }
  return column;
}

// The body and the two summary rows.
TextTable body_of(const Table& table) {
  TextTable text{{""}, {}, table.rows.size()};
  text.header.insert(text.header.end(), table.columns.begin(), table.columns.end());
  const auto add = [&](const Table::Row& row) {
    const std::set<std::size_t> best = best_of(table, row);
    text.rows.push_back({{row.label, false}});
    for (std::size_t c = 0; c < row.entries.size(); ++c)
      text.rows.back().push_back({row.entries[c].value ? short_text(*row.entries[c].value) : "–", best.contains(c)});
  };
  for (const Table::Row& row : table.rows) add(row);
  for (const bool is_mean : {true, false}) {
    if (table.complete_rows == 0) break;
    Table::Row row{(is_mean ? "mean of " : "median of ") + std::to_string(table.complete_rows), {}};
    for (const Table::Summary& s : table.summaries) row.entries.push_back({is_mean ? s.mean : s.median, ""});
    add(row);
  }
  return text;
}

}  // namespace

Table make_table(const Overview& overview, const std::vector<Record>& records, const RunMetric& metric) {
  Table table{metric, overview.title, overview.baseline, overview.methods, {}, {}, 0};
  for (const std::string& label : labels_of(sorted_by_row(overview, records), row_label)) {
    Table::Row row{label, {}};
    for (const std::string& method : overview.methods)
      row.entries.push_back(entry_of(records, label, method, metric.name));
    table.rows.push_back(std::move(row));
  }
  summarise(table);
  return table;
}

std::string to_markdown(const Table& table) {
  std::string out = "**" + table.title + "** — " + legend(table.metric) + "\n\n" + markdown(body_of(table)) + "\n";
  for (const std::string& note : notes_of(table)) out += "- " + note + "\n";
  return out;
}

std::string to_html(const Table& table) {
  std::string out = html(body_of(table)) + "<ul class=\"note\">";
  for (const std::string& note : notes_of(table)) out += "<li>" + html_text(note) + "</li>";
  return out + "</ul>\n";
}

std::string legend(const RunMetric& metric) {
  const char* better = metric.better == Direction::lower    ? "lower is better"
                       : metric.better == Direction::higher ? "higher is better"
                                                            : "";
  return metric.name + (metric.unit.empty() ? "" : " (" + metric.unit + ")") + ": " + metric.formula +
         (*better ? "; " : "") + better;
}

TextTable summary(const Overview& overview, const std::vector<Record>& records) {
  TextTable text{{"method"}, {}};
  for (const RunMetric& metric : overview.metrics) {
    const std::string unit = metric.unit == "% of the diagonal" ? ", %" : metric.unit.empty() ? "" : ", " + metric.unit;
    const char* arrow = metric.better == Direction::lower ? " ↓" : metric.better == Direction::higher ? " ↑" : "";
    text.header.push_back(metric.name + unit + arrow);
  }
  for (const std::string& swept : swept_values(overview, records)) {
    std::vector<Record> part;
    std::copy_if(records.begin(), records.end(), std::back_inserter(part),
                 [&](const Record& r) { return text_of(r.swept) == swept; });
    const std::size_t first = text.rows.size();
    for (const std::string& method : overview.methods)
      text.rows.push_back({{method + (swept.empty() ? "" : ", " + swept), false}});
    for (const RunMetric& metric : overview.metrics) {
      const std::vector<TextTable::Entry> column = summary_column(make_table(overview, part, metric));
      for (std::size_t m = 0; m < column.size(); ++m) text.rows[first + m].push_back(column[m]);
    }
  }
  return text;
}

std::string to_csv(const Table& table) {
  std::ostringstream out;
  out << "row";
  for (const std::string& column : table.columns) out << "," << csv_text(column);
  out << "\n";
  for (const Table::Row& row : table.rows) {
    out << csv_text(row.label);
    for (const Table::Entry& entry : row.entries) out << "," << (entry.value ? exact_text(*entry.value) : "");
    out << "\n";
  }
  return out.str();
}

std::string to_latex(const Table& table) {
  return "% " + table.title + "; " + legend(table.metric) + "\n" + latex(body_of(table));
}

std::string long_csv(const std::vector<Record>& records) {
  std::ostringstream out;
  out << "spec,model,method,swept,seed,status,metric,value\n";
  for (const Record& r : records) {
    const std::string key = csv_text(r.spec) + "," + csv_text(r.model) + "," + csv_text(r.method) + "," +
                            csv_text(text_of(r.swept)) + "," + std::to_string(r.seed) + "," + csv_text(r.status) + ",";
    if (r.metrics.empty()) out << key << ",\n";
    for (const auto& [name, value] : r.metrics) out << key << name << "," << exact_text(value) << "\n";
  }
  return out.str();
}

}  // namespace carve::experiments
