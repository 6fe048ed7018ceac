#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace carve::experiments {

/// A table as it is read: every entry already text, the same in every format it is written in.
struct TextTable {
  struct Entry {
    std::string text;
    bool best = false;  // in bold
  };
  std::vector<std::string> header;
  std::vector<std::vector<Entry>> rows;
  std::size_t ruled = static_cast<std::size_t>(-1);  // the row that a line stands above, as before means
};

/// Rows as columns: what stood in the first column is the header, and the other way round.
TextTable transposed(const TextTable& table);

/// The table as it fits a page's width: as it is; if it is too wide, transposed; if both are, the narrower one in parts
/// that stand below each other. Every format below is written of these parts.
std::vector<TextTable> fitted(const TextTable& table);

std::string markdown(const TextTable& table);
std::string html(const TextTable& table);
std::string latex(const TextTable& table);  // a tabular for booktabs

/// Four significant digits, C locale; a dash for what is not finite.
std::string short_text(double value);
/// The shortest text that reads back as the same value, C locale; `otherwise` for what is not finite.
std::string exact_text(double value, const char* otherwise = "");

/// Text as it may stand in an HTML element or attribute.
std::string html_text(const std::string& text);
std::string joined(const std::vector<std::string>& parts, const std::string& between);

}  // namespace carve::experiments
