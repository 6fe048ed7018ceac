#include "report/table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <set>
#include <sstream>

namespace carve::experiments {
namespace {

std::string exact_text(double value) {
  if (!std::isfinite(value)) return "";
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

std::string row_label(const Record& record) {
  return record.swept.empty() ? record.model : record.model + ", " + text_of(record.swept);
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string latex_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (std::string("_%&#$").find(c) != std::string::npos) out += '\\';
    out += c;
  }
  return out;
}

// Rows in the order of models, then of the records' own paths with numbers in numeric order.
std::vector<std::string> row_order(const Overview& overview, const std::vector<Record>& records) {
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
  std::vector<std::string> labels;
  for (const Record* record : sorted)
    if (const std::string label = row_label(*record); std::find(labels.begin(), labels.end(), label) == labels.end())
      labels.push_back(label);
  return labels;
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

void summarise(Table& table) {
  std::vector<std::vector<double>> columns(table.columns.size());
  for (const Table::Row& row : table.rows) {
    if (!std::all_of(row.entries.begin(), row.entries.end(), [](const Table::Entry& e) { return e.value.has_value(); }))
      continue;
    ++table.complete_rows;
    for (std::size_t c = 0; c < columns.size(); ++c) columns[c].push_back(*row.entries[c].value);
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

using Style = std::function<std::string(const std::string&)>;

// Rows of text: the body and the two summary rows, the best of each row through `bold`.
std::vector<std::vector<std::string>> text_rows(const Table& table, const Style& escape, const Style& bold) {
  std::vector<std::vector<std::string>> rows;
  for (const Table::Row& row : table.rows) {
    const std::set<std::size_t> best = best_of(table, row);
    rows.push_back({escape(row.label)});
    for (std::size_t c = 0; c < row.entries.size(); ++c) {
      const std::string text = row.entries[c].value ? short_text(*row.entries[c].value) : "–";
      rows.back().push_back(best.contains(c) ? bold(text) : text);
    }
  }
  for (const bool is_mean : {true, false}) {
    Table::Row row{(is_mean ? "mean of " : "median of ") + std::to_string(table.complete_rows), {}};
    for (const Table::Summary& s : table.summaries) row.entries.push_back({is_mean ? s.mean : s.median, ""});
    const std::set<std::size_t> best = best_of(table, row);
    rows.push_back({row.label});
    for (std::size_t c = 0; c < row.entries.size(); ++c) {
      const std::string text = short_text(*row.entries[c].value);
      rows.back().push_back(best.contains(c) ? bold(text) : text);
    }
  }
  return rows;
}

std::string joined(const std::vector<std::string>& parts, const std::string& between) {
  std::string all;
  for (std::size_t i = 0; i < parts.size(); ++i) all += (i ? between : "") + parts[i];
  return all;
}

// Differences from the baseline, and why entries are missing.
std::vector<std::string> notes_of(const Table& table) {
  std::vector<std::string> notes;
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (const auto& d = table.summaries[c].to_baseline)
      notes.push_back(table.columns[c] + " − " + table.baseline + ": " + difference_text(*d, table.metric.better));
  std::set<std::string> reasons;
  for (const Table::Row& row : table.rows)
    for (std::size_t c = 0; c < row.entries.size(); ++c)
      if (!row.entries[c].value && reasons.insert(table.columns[c] + row.entries[c].why).second)
        notes.push_back("–: " + table.columns[c] + " on " + row.label + ": " + row.entries[c].why);
  return notes;
}

std::string legend(const RunMetric& metric) {
  const char* better = metric.better == Direction::lower    ? "lower is better"
                       : metric.better == Direction::higher ? "higher is better"
                                                            : "";
  return metric.name + (metric.unit.empty() ? "" : " (" + metric.unit + ")") + ": " + metric.formula +
         (*better ? "; " : "") + better;
}

}  // namespace

std::string short_text(double value) {
  if (!std::isfinite(value)) return "-";
  char buffer[48];
  const double size = std::abs(value);
  const bool plain = size == 0 || (size >= 1e-4 && size < 1e7);
  const int decimals = size >= 1000 ? 0
                       : size == 0  ? 0
                                    : std::max(0, 3 - static_cast<int>(std::floor(std::log10(size))));
  const auto end = plain ? std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, decimals)
                         : std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::scientific, 2);
  return {buffer, end.ptr};
}

std::string html_text(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
  return out;
}

Table make_table(const Overview& overview, const std::vector<Record>& records, const RunMetric& metric) {
  Table table{metric, overview.title, overview.baseline, overview.methods, {}, {}, 0};
  for (const std::string& label : row_order(overview, records)) {
    Table::Row row{label, {}};
    for (const std::string& method : overview.methods)
      row.entries.push_back(entry_of(records, label, method, metric.name));
    table.rows.push_back(std::move(row));
  }
  summarise(table);
  return table;
}

std::string to_markdown(const Table& table) {
  std::ostringstream out;
  out << "**" << table.title << "** — " << legend(table.metric) << "\n\n| | " << joined(table.columns, " | ")
      << " |\n|---|";
  for (std::size_t c = 0; c < table.columns.size(); ++c) out << "---:|";
  out << "\n";
  const auto rows = text_rows(
      table, [](const std::string& t) { return t; }, [](const std::string& t) { return "**" + t + "**"; });
  for (const auto& row : rows) out << "| " << joined(row, " | ") << " |\n";
  out << "\n";
  for (const std::string& note : notes_of(table)) out << "- " << note << "\n";
  return out.str();
}

std::string to_html(const Table& table) {
  std::ostringstream out;
  out << "<h3>" << html_text(table.metric.name) << "</h3><p class=\"note\">" << html_text(legend(table.metric))
      << "</p><div class=\"wide\"><table><tr><th></th>";
  for (const std::string& column : table.columns) out << "<th>" << html_text(column) << "</th>";
  out << "</tr>\n";
  constexpr char kBest = '\1';  // cannot stand in a name
  const auto rows = text_rows(table, html_text, [](const std::string& t) { return kBest + t; });
  for (std::size_t i = 0; i < rows.size(); ++i) {
    out << (i == table.rows.size() ? "<tr class=\"summary\">" : "<tr>");
    for (const std::string& text : rows[i])
      out << (text.starts_with(kBest) ? "<td class=\"best\">" + text.substr(1) : "<td>" + text) << "</td>";
    out << "</tr>\n";
  }
  out << "</table></div><ul class=\"note\">";
  for (const std::string& note : notes_of(table)) out << "<li>" << html_text(note) << "</li>";
  out << "</ul>\n";
  return out.str();
}

std::string to_csv(const Table& table) {
  std::ostringstream out;
  out << "row";
  for (const std::string& column : table.columns) out << "," << quoted(column);
  out << "\n";
  for (const Table::Row& row : table.rows) {
    out << quoted(row.label);
    for (const Table::Entry& entry : row.entries) out << "," << (entry.value ? exact_text(*entry.value) : "");
    out << "\n";
  }
  return out.str();
}

std::string to_latex(const Table& table) {
  std::ostringstream out;
  out << "% " << table.title << "; " << legend(table.metric) << "\n\\begin{tabular}{l"
      << std::string(table.columns.size(), 'r') << "}\n\\toprule\n";
  for (const std::string& column : table.columns) out << " & " << latex_text(column);
  out << " \\\\\n\\midrule\n";
  const auto rows = text_rows(table, latex_text, [](const std::string& t) { return "\\textbf{" + t + "}"; });
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i == table.rows.size()) out << "\\midrule\n";
    std::string line = joined(rows[i], " & ");
    for (std::size_t dash; (dash = line.find("–")) != std::string::npos;)
      line.replace(dash, std::string("–").size(), "--");
    out << line << " \\\\\n";
  }
  out << "\\bottomrule\n\\end{tabular}\n";
  return out.str();
}

std::string long_csv(const std::vector<Record>& records) {
  std::ostringstream out;
  out << "spec,model,method,swept,seed,status,metric,value\n";
  for (const Record& r : records) {
    const std::string key = quoted(r.spec) + "," + quoted(r.model) + "," + quoted(r.method) + "," +
                            quoted(text_of(r.swept)) + "," + std::to_string(r.seed) + "," + quoted(r.status) + ",";
    if (r.metrics.empty()) out << key << ",\n";
    for (const auto& [name, value] : r.metrics) out << key << name << "," << exact_text(value) << "\n";
  }
  return out.str();
}

}  // namespace carve::experiments
