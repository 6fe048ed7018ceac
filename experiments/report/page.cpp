#include "report/page.h"

#include <algorithm>
#include <sstream>

#include "carve/core/file.h"
#include "report/table.h"

namespace carve::experiments {
namespace fs = std::filesystem;
namespace {

constexpr const char* kStyle = R"(
:root { color-scheme: light; --ink: #1d2433; --soft: #5b6577; --line: #d9dee7; --best: #e6f2ec; }
body { font: 16px/1.5 system-ui, sans-serif; color: var(--ink); max-width: 72rem; margin: 0 auto; padding: 1rem; }
h1 { font-size: 1.7rem; } h2 { margin-top: 3rem; border-bottom: 2px solid var(--line); } h3 { margin-bottom: .2rem; }
p.note, figcaption, footer { color: var(--soft); font-size: .9rem; margin: .2rem 0 .6rem; }
nav a { margin-right: 1rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: .92rem; }
th, td { padding: .25rem .7rem; text-align: right; border-bottom: 1px solid var(--line); }
th:first-child, td:first-child { text-align: left; } tr.summary td { border-top: 1px solid var(--ink); }
td.best { background: var(--best); font-weight: 600; }
figure { margin: 1rem 0; } figure img { max-width: 100%; height: auto; }
ul { padding-left: 1.2rem; }
@media print { body { max-width: none; font-size: 11px; } h2 { break-before: page; } figure, table { break-inside: avoid; } nav { display: none; } }
)";

std::string base64(const std::string& bytes) {
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned block = 0;
    for (std::size_t k = 0; k < 3; ++k)
      block = block << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? digits[block >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

std::vector<fs::path> files_in(const fs::path& folder, const std::string& ending) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none))
    if (entry.path().extension() == ending) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

void html_figures(std::ostream& out, const fs::path& folder, const std::string& ending, const char* type) {
  for (const fs::path& file : files_in(folder, ending))
    out << "<figure><img alt=\"" << html_text(file.stem().string()) << "\" src=\"data:image/" << type << ";base64,"
        << base64(read_file(file)) << "\"><figcaption>" << html_text(file.stem().string())
        << "</figcaption></figure>\n";
}

void html_spec(std::ostream& out, const fs::path& results, const std::string& name) {
  const fs::path folder = results / name;
  const Results found = load_results(folder);
  const auto done = std::count_if(found.records.begin(), found.records.end(), [](const Record& r) { return r.done(); });
  out << "<h2 id=\"" << html_text(name) << "\">" << html_text(found.overview.title) << "</h2>\n<p class=\"note\">"
      << done << " of " << found.overview.runs << " runs have a result; every run and metric: " << html_text(name)
      << "/tables/runs.csv</p>\n";
  for (const RunMetric& metric : found.overview.metrics)
    out << to_html(make_table(found.overview, found.records, metric));
  html_figures(out, folder / "plots", ".svg", "svg+xml");
  html_figures(out, folder / "heat_maps", ".png", "png");
  for (const std::string& complaint : found.complaints) out << "<p class=\"note\">" << html_text(complaint) << "</p>\n";
}

// What the figures rest on: the distinct values of the runs' provenance, of which times of day say nothing.
void html_provenance(std::ostream& out, const fs::path& results) {
  std::map<std::string, std::vector<std::string>> values;
  for (const std::string& name : specs_in(results))
    for (const Record& record : load_results(results / name).records)
      for (const auto& [key, value] : record.provenance) {
        std::vector<std::string>& known = values[key];
        if (key != "date" && key != "reference" && std::find(known.begin(), known.end(), value) == known.end())
          known.push_back(value);
      }
  out << "<footer><h2>Where the figures come from</h2><ul>\n";
  for (const auto& [key, known] : values) {
    if (known.empty()) continue;
    out << "<li>" << html_text(key) << ": ";
    for (std::size_t i = 0; i < known.size(); ++i) out << (i ? "; " : "") << html_text(known[i]);
    out << "</li>\n";
  }
  out << "</ul></footer>\n";
}

}  // namespace

std::string html_report(const fs::path& results) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
         "content=\"width=device-width, "
         "initial-scale=1\"><title>Carve: results</title><style>"
      << kStyle << "</style></head><body>\n<h1>Carve: results</h1>\n<nav>";
  for (const std::string& name : specs_in(results))
    out << "<a href=\"#" << html_text(name) << "\">" << html_text(name) << "</a>";
  out << "</nav>\n";
  for (const std::string& name : specs_in(results)) html_spec(out, results, name);
  html_provenance(out, results);
  out << "</body></html>\n";
  return out.str();
}

std::string markdown_report(const fs::path& results) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << "# Results\n\n";
  for (const std::string& name : specs_in(results)) {
    const fs::path folder = results / name;
    const Results found = load_results(folder);
    out << "## " << found.overview.title << "\n\n";
    for (const RunMetric& metric : found.overview.metrics)
      out << to_markdown(make_table(found.overview, found.records, metric)) << "\n";
    for (const char* part : {"plots", "heat_maps"})
      for (const fs::path& file : files_in(folder / part, ".png"))
        out << "![" << file.stem().string() << "](" << name << "/" << part << "/" << file.filename().string()
            << ")\n\n";
  }
  return out.str();
}

}  // namespace carve::experiments
