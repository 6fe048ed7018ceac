#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "eval/metrics.h"

namespace carve {

/// The scores of one compared file.
struct Row {
  std::string file;
  std::size_t vertices = 0, triangles = 0;
  std::vector<Score> scores;
};

/// What a comparison's figures rest on, printed with every one of them.
struct ReportHead {
  std::string reference;
  std::size_t vertices = 0, triangles = 0;
  double diagonal = 0;
  CompareOptions options;
};

/// Text as a field of CSV, quoted where it must be (RFC 4180).
std::string csv_text(const std::string& text);

/// A line a metric with its definition; a column a compared file.
void write_text(std::ostream& out, const ReportHead& head, const std::vector<Row>& rows);
/// A line a compared file and metric. Empty = not defined for these inputs.
void write_csv(std::ostream& out, const ReportHead& head, const std::vector<Row>& rows);
/// {"reference", "options", "metrics": definitions, "results": [{"file", "values": {name: {"value", "percent"}}}]}
std::string to_json(const ReportHead& head, const std::vector<Row>& rows);

}  // namespace carve
