#pragma once
#include <filesystem>
#include <string>

namespace carve::experiments {

/// One self-contained HTML page of all results below a folder: per spec its tables, figures (plots/*.svg) and heat maps
/// (heat_maps/*.png), embedded; readable offline, on a phone and in print. Reads files in `results` only.
std::string html_report(const std::filesystem::path& results);

/// The same as Markdown, with links to the pictures.
std::string markdown_report(const std::filesystem::path& results);

}  // namespace carve::experiments
