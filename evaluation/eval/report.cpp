#include "eval/report.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <ostream>

#include "carve/core/options.h"

namespace carve {
namespace {

using Json = nlohmann::ordered_json;

std::string digits(double value) {
  char buffer[32];
  return std::string(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

std::string rounded(double value, const char* format) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

std::string cell(const Score& score) {
  if (!score.value) return "-";
  switch (score.metric->unit) {
    case Unit::flag:
      return *score.value != 0 ? "yes" : "no";
    case Unit::count:
      return rounded(*score.value, "%.0f");
    case Unit::share:
      return rounded(*score.value, "%.6f");
    default:
      return rounded(*score.percent, "%.6g %%  ") + rounded(*score.value, "%.6g");
  }
}

std::string padded(std::string text, std::size_t width) {
  text.resize(std::max(width, text.size()), ' ');
  return text;
}

}  // namespace

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

void write_text(std::ostream& out, const ReportHead& head, const std::vector<Row>& rows) {
  out << "reference " << head.reference << ": " << head.vertices << " vertices, " << head.triangles
      << " triangles, diagonal " << rounded(head.diagonal, "%.9g") << "\n"
      << "lengths: % of that diagonal, then the model's unit; " << head.options.samples << " samples a mesh, seed "
      << head.options.seed << ", sign by " << names(head.options.sign)[static_cast<int>(head.options.sign)] << "\n";
  std::vector<std::size_t> widths;
  for (const Row& row : rows) {
    out << "compared  " << row.file << ": " << row.vertices << " vertices, " << row.triangles << " triangles\n";
    widths.push_back(row.file.size());
    for (const Score& score : row.scores) widths.back() = std::max(widths.back(), cell(score).size());
  }
  out << "\n" << padded("metric", 20);
  for (std::size_t r = 0; r < rows.size(); ++r) out << "  " << padded(rows[r].file, widths[r]);
  out << "  better  definition (V, C: vertices and surface compared; R: reference; S: samples)\n";
  for (std::size_t i = 0; !rows.empty() && i < rows[0].scores.size(); ++i) {
    const Score& first = rows[0].scores[i];
    out << padded(first.name(), 20);
    for (std::size_t r = 0; r < rows.size(); ++r) out << "  " << padded(cell(rows[r].scores[i]), widths[r]);
    out << "  " << padded(name(first.metric->better), 6) << "  " << first.metric->formula << "\n";
  }
}

void write_csv(std::ostream& out, const ReportHead& head, const std::vector<Row>& rows) {
  out << "compared,reference,metric,value,percent_of_diagonal,unit,better,samples,seed,definition\n";
  for (const Row& row : rows)
    for (const Score& score : row.scores)
      out << csv_text(row.file) << ',' << csv_text(head.reference) << ',' << score.name() << ','
          << (score.value ? digits(*score.value) : "") << ',' << (score.percent ? digits(*score.percent) : "") << ','
          << name(score.metric->unit) << ',' << name(score.metric->better) << ',' << head.options.samples << ','
          << head.options.seed << ',' << csv_text(score.metric->formula) << '\n';
}

std::string to_json(const ReportHead& head, const std::vector<Row>& rows) {
  CompareOptions options = head.options;
  std::vector<Field> fields;
  add_fields(fields, "", options);
  Json definitions = Json::array();
  for (const Metric& m : metrics())
    definitions.push_back(
        {{"name", m.name}, {"formula", m.formula}, {"unit", name(m.unit)}, {"better", name(m.better)}});
  Json results = Json::array();
  for (const Row& row : rows) {
    Json values = Json::object();
    for (const Score& score : row.scores)
      values[score.name()] = {{"value", score.value ? Json(*score.value) : Json()},
                              {"percent", score.percent ? Json(*score.percent) : Json()}};
    results.push_back(
        {{"file", row.file}, {"vertices", row.vertices}, {"triangles", row.triangles}, {"values", values}});
  }
  const Json all = {{"reference",
                     {{"file", head.reference},
                      {"vertices", head.vertices},
                      {"triangles", head.triangles},
                      {"diagonal", head.diagonal}}},
                    {"options", Json::parse(to_json(fields))},
                    {"metrics", definitions},
                    {"results", results}};
  return all.dump(2);
}

}  // namespace carve
