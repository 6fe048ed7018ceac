#include "report/page.h"

#include <webp/encode.h>

#include <algorithm>
#include <sstream>

#include "carve/core/embed.h"
#include "carve/core/error.h"
#include "carve/core/file.h"
#include "carve/image/read_image.h"
#include "report/display_mesh.h"
#include "report/front.h"
#include "report/table.h"
#include "report/viewer.h"

CARVE_EMBED(char, carve_style, CARVE_STYLE);

namespace carve::experiments {
namespace fs = std::filesystem;
namespace {

constexpr const char* kSummaryNote =
    "Means over the rows that every method has, in brackets the change from the baseline; arrows point to the better "
    "side, "
    "the best of a column is marked. Lengths are in % of the diagonal of the reference's box.";

// A picture as WebP: a tenth of its PNG, which stays in the results.
std::string webp(const fs::path& file) {
  const Picture picture = read_image(file);
  constexpr float kQuality = 85;
  std::uint8_t* bytes = nullptr;
  const std::size_t size =
      WebPEncodeRGBA(&picture.pixels.front().r, picture.width, picture.height, 4 * picture.width, kQuality, &bytes);
  if (size == 0) throw IoError(file.string(), "cannot be written as WebP");
  std::string encoded(reinterpret_cast<const char*>(bytes), size);
  WebPFree(bytes);
  return encoded;
}

std::vector<fs::path> files_in(const fs::path& folder, const std::string& ending) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none))
    if (entry.path().extension() == ending) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::string figure_of(const std::string& title, const std::string& type, const std::string& bytes) {
  return "<figure><img loading=\"lazy\" alt=\"" + html_text(title) + "\" src=\"data:image/" + type + ";base64," +
         base64(bytes) + "\"><figcaption>" + html_text(title) + "</figcaption></figure>\n";
}

void html_pictures(std::ostream& out, const fs::path& folder, const char* title) {
  const std::vector<fs::path> files = files_in(folder, ".png");
  if (files.empty()) return;
  out << "<h3>" << title << "</h3>\n<div class=\"gallery\">\n";
  for (const fs::path& file : files) out << figure_of(file.stem().string(), "webp", webp(file));
  out << "</div>\n";
}

void html_spec(std::ostream& out, const fs::path& results, const std::string& name, const Results& found) {
  const fs::path folder = results / name;
  const auto done = std::count_if(found.records.begin(), found.records.end(), [](const Record& r) { return r.done(); });
  out << "<section><h2 id=\"" << html_text(name) << "\">" << html_text(found.overview.title)
      << "</h2>\n<p class=\"note\">" << done << " of " << found.overview.runs.size()
      << " runs have a result; every run and metric: " << html_text(name)
      << "/tables/runs.csv</p>\n<h3>Summary</h3>\n<div class=\"summary\">" << html(summary(found.overview, found.rows))
      << "</div>"
      << "<p class=\"note\">" << kSummaryNote << "</p>\n";
  for (const RunMetric& metric : found.overview.metrics) {
    out << "<h3>" << html_text(metric.name) << "</h3><p class=\"note\">" << html_text(legend(metric))
        << "</p>\n<div class=\"metric\"><div>" << to_html(make_table(found.overview, found.rows, metric))
        << "</div><div>";
    if (const fs::path file = folder / "plots" / (metric.name + ".svg"); fs::exists(file))
      out << figure_of(found.overview.title + ": " + metric.name, "svg+xml", read_file(file));
    out << "</div></div>\n";
  }
  html_pictures(out, folder / "heat_maps", "Signed distance to the reference");
  html_pictures(out, folder / "renders", "Drawings and meshes");
  for (const std::string& complaint : found.complaints) out << "<p class=\"note\">" << html_text(complaint) << "</p>\n";
  out << "</section>\n";
}

std::string link_to(const std::string& anchor, const std::string& text) {
  return "<a href=\"#" + html_text(anchor) + "\">" + html_text(text) + "</a>";
}

void html_front(std::ostream& out, const NamedResults& specs, const Front& front) {
  for (const std::string& line : front.lines) out << "<p>" << html_text(line) << "</p>\n";
  out << "<div class=\"front\"><div><h3>Experiments</h3>\n<div class=\"wide\"><table><thead><tr>";
  for (std::size_t c = 0; c < front.runs.header.size(); ++c)
    if (c != 1) out << "<th>" << html_text(front.runs.header[c]) << "</th>";
  out << "</tr></thead>\n";
  for (std::size_t i = 0; i < specs.size(); ++i) {
    out << "<tr><td>" << link_to(specs[i].first, specs[i].second.overview.title) << "</td>";
    for (std::size_t c = 2; c < front.runs.rows[i].size(); ++c) out << "<td>" << front.runs.rows[i][c].text << "</td>";
    out << "</tr>\n";
  }
  out << "</table></div>\n<p>" << link_to("meshes", "Meshes in 3-D") << " · "
      << link_to("published", "Published and measured") << " · " << link_to("provenance", "Where the figures come from")
      << "</p></div>\n";
  if (!front.thesis.empty()) out << "<div><h3>Tables and figures of the thesis</h3>\n<ul class=\"thesis\">\n";
  for (const Front::Place& place : front.thesis) {
    out << "<li>" << html_text(place.what) << ": ";
    for (std::size_t i = 0; i < place.anchors.size(); ++i)
      out << (i ? ", " : "") << link_to(place.anchors[i], place.anchors[i]);
    out << "</li>\n";
  }
  out << (front.thesis.empty() ? "</div>\n" : "</ul></div></div>\n");
}

// What the figures rest on: the distinct values of the runs' provenance, of which times of day say nothing.
void html_provenance(std::ostream& out, const NamedResults& specs) {
  std::map<std::string, std::vector<std::string>> values;
  for (const auto& [name, found] : specs)
    for (const Record& record : found.records)
      for (const auto& [key, value] : record.provenance) {
        std::vector<std::string>& known = values[key];
        if (key != "date" && key != "load" && key != kReferenceKey &&
            std::find(known.begin(), known.end(), value) == known.end())
          known.push_back(value);
      }
  out << "<footer><h2 id=\"provenance\">Where the figures come from</h2><ul>\n";
  for (const auto& [key, known] : values) {
    if (known.empty()) continue;
    out << "<li>" << html_text(key) << ": ";
    for (std::size_t i = 0; i < known.size(); ++i) out << (i ? "; " : "") << html_text(known[i]);
    out << "</li>\n";
  }
  out << "</ul></footer>\n";
}

}  // namespace

std::string html_report(const fs::path& results, const ReportOptions& options) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  const NamedResults specs = load_all(results);
  const std::vector<PublishedTable> published = published_tables(options.published, results);
  out << "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
         "content=\"width=device-width, initial-scale=1\"><title>Carve: results</title><link rel=\"icon\" "
         "href=\"data:,\"><style>"
      << carve_style << "</style></head><body>\n<h1>Carve: results</h1>\n";
  html_front(out, specs, front_of(specs, published));
  out << viewer_html(results, options.three, options.mesh_megabytes);
  for (const auto& [name, found] : specs) html_spec(out, results, name, found);
  if (!published.empty()) out << "<section><h2 id=\"published\">Published and measured</h2>\n";
  for (const PublishedTable& table : published) {
    out << "<h3 id=\"" << anchor_of(table) << "\">" << html_text(table.title) << "</h3>\n"
        << html(table.table) << "<ul class=\"note\">";
    for (const std::string& note : table.notes) out << "<li>" << html_text(note) << "</li>";
    out << "</ul>\n";
  }
  if (!published.empty()) out << "</section>\n";
  html_provenance(out, specs);
  out << "</body></html>\n";
  return out.str();
}

std::string markdown_report(const fs::path& results, const ReportOptions& options) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << "# Results\n\n";
  const NamedResults specs = load_all(results);
  const std::vector<PublishedTable> published = published_tables(options.published, results);
  const Front front = front_of(specs, published);
  for (const std::string& line : front.lines) out << line << "\n\n";
  out << markdown(front.runs) << "\n";
  for (const auto& [name, found] : specs) {
    const fs::path folder = results / name;
    out << "## " << found.overview.title << "\n\n"
        << markdown(summary(found.overview, found.rows)) << "\n"
        << kSummaryNote << "\n\n";
    for (const RunMetric& metric : found.overview.metrics)
      out << to_markdown(make_table(found.overview, found.rows, metric)) << "\n";
    for (const char* part : {"plots", "heat_maps", "renders"})
      for (const fs::path& file : files_in(folder / part, ".png"))
        out << "![" << file.stem().string() << "](<" << name << "/" << part << "/" << file.filename().string()
            << ">)\n\n";
  }
  for (const PublishedTable& table : published) {
    out << "## " << table.title << "\n\n" << markdown(table.table) << "\n";
    for (const std::string& note : table.notes) out << "- " << note << "\n";
    out << "\n";
  }
  return out.str();
}

}  // namespace carve::experiments
