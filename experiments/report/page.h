#pragma once
#include <filesystem>
#include <string>

namespace carve::experiments {

struct ReportOptions {
  std::filesystem::path published;  // folder of the thesis's tables (papers/published); empty: leave them out
  std::filesystem::path three;      // folder of three.js, for the 3-D view
  double mesh_megabytes = 10;       // of the page, for the 3-D view
};

/// One self-contained HTML page of all results below a folder: what ran and where each table and figure of the thesis
/// is (report/front.h); a rotatable view of every run's mesh; per spec its
/// summary, tables, figures (plots/*.svg), heat maps and renders (*.png, as WebP), embedded; published tables beside
/// measured ones. Readable offline, on a phone and in print.
std::string html_report(const std::filesystem::path& results, const ReportOptions& options);

/// The same as Markdown, with links to the pictures and without the view.
std::string markdown_report(const std::filesystem::path& results, const ReportOptions& options);

}  // namespace carve::experiments
