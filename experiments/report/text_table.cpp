#include "report/text_table.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numeric>
#include <span>
#include <string_view>

namespace carve::experiments {
namespace {

using Replacement = std::pair<std::string_view, std::string_view>;

std::string replaced(const std::string& text, std::span<const Replacement> replacements) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const auto found = std::find_if(replacements.begin(), replacements.end(), [&](const Replacement& r) {
      return text.compare(at, r.first.size(), r.first) == 0;
    });
    out += found == replacements.end() ? std::string_view(text).substr(at, 1) : found->second;
    at += found == replacements.end() ? 1 : found->first.size();
  }
  return out;
}

std::string latex_text(const std::string& text) {
  static constexpr Replacement kCodes[] = {{"\\", "\\textbackslash{}"},
                                           {"{", "\\{"},
                                           {"}", "\\}"},
                                           {"_", "\\_"},
                                           {"%", "\\%"},
                                           {"&", "\\&"},
                                           {"#", "\\#"},
                                           {"$", "\\$"},
                                           {"^", "\\^{}"},
                                           {"~", "\\~{}"},
                                           {"<", "$<$"},
                                           {">", "$>$"},
                                           {"|", "$|$"},
                                           {"–", "--"},
                                           {"\u00a0", "~"},
                                           {"−", "$-$"},
                                           {"↓", "$\\downarrow$"},
                                           {"↑", "$\\uparrow$"},
                                           {"×", "$\\times$"}};
  return replaced(text, kCodes);
}

std::string markdown_text(const std::string& text) {
  static constexpr Replacement kCodes[] = {{"|", "\\|"}, {"*", "\\*"}, {"<", "&lt;"}};
  return replaced(text, kCodes);
}

// A header's pieces, between which a line may end: words, and names at their underscores, slashes and dots.
std::vector<std::string> pieces_of(const std::string& text) {
  std::vector<std::string> pieces = {""};
  for (std::size_t i = 0; i < text.size(); ++i) {
    pieces.back() += text[i];
    const bool letter_next = i + 1 < text.size() && std::isalpha(static_cast<unsigned char>(text[i + 1])) != 0;
    if (i + 1 < text.size() && (text[i] == ' ' || text[i] == '_' || text[i] == '/' || (text[i] == '.' && letter_next)))
      pieces.emplace_back();
  }
  return pieces;
}

std::size_t letters(const std::string& text) {  // of UTF-8
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

std::size_t longest(const std::vector<std::string>& pieces) {
  std::size_t most = 0;
  for (const std::string& piece : pieces) most = std::max(most, letters(piece));
  return most;
}

// What A4 in print holds in the page's type, and a two-column paper across both; the room between two columns.
constexpr std::size_t kPageLetters = 112, kGap = 2;

std::vector<std::size_t> widths_of(const TextTable& table) {
  std::vector<std::size_t> widths;
  for (std::size_t c = 0; c < table.header.size(); ++c) {
    widths.push_back(c == 0 ? letters(table.header[c]) : longest(pieces_of(table.header[c])));
    for (const auto& row : table.rows) widths.back() = std::max(widths.back(), letters(row[c].text));
    widths.back() += kGap;
  }
  return widths;
}

std::size_t width_of(const TextTable& table) {
  const std::vector<std::size_t> widths = widths_of(table);
  return std::accumulate(widths.begin(), widths.end(), std::size_t{0});
}

// The columns that parts begin with, each part no wider than `limit` if it has more than one column beside the first.
std::vector<std::size_t> cuts_of(const std::vector<std::size_t>& widths, std::size_t limit) {
  std::vector<std::size_t> cuts;
  std::size_t width = 0;
  for (std::size_t c = 1; c < widths.size(); ++c) {
    if (cuts.empty() || width + widths[c] > limit) {
      cuts.push_back(c);
      width = widths[0];
    }
    width += widths[c];
  }
  return cuts;
}

// As few parts as the page allows, of about the same width; all have the first column.
std::vector<TextTable> parts_of(const TextTable& table) {
  const std::vector<std::size_t> widths = widths_of(table);
  std::vector<std::size_t> cuts = cuts_of(widths, kPageLetters);
  for (std::size_t limit = kPageLetters; limit > 0; --limit) {
    std::vector<std::size_t> narrower = cuts_of(widths, limit);
    if (narrower.size() > cuts.size()) break;
    cuts = std::move(narrower);
  }
  cuts.push_back(widths.size());
  std::vector<TextTable> parts;
  for (std::size_t p = 0; p + 1 < cuts.size(); ++p) {
    TextTable part{{table.header[0]}, {}, table.ruled};
    part.header.insert(part.header.end(), table.header.begin() + static_cast<std::ptrdiff_t>(cuts[p]),
                       table.header.begin() + static_cast<std::ptrdiff_t>(cuts[p + 1]));
    for (const auto& row : table.rows) {
      part.rows.push_back({row[0]});
      part.rows.back().insert(part.rows.back().end(), row.begin() + static_cast<std::ptrdiff_t>(cuts[p]),
                              row.begin() + static_cast<std::ptrdiff_t>(cuts[p + 1]));
    }
    parts.push_back(std::move(part));
  }
  return parts;
}

std::string markdown_part(const TextTable& table) {
  std::vector<std::string> header;
  for (const std::string& column : table.header) header.push_back(markdown_text(column));
  std::string out = "| " + joined(header, " | ") + " |\n|---|";
  for (std::size_t c = 1; c < table.header.size(); ++c) out += "---:|";
  out += "\n";
  for (const auto& row : table.rows) {
    out += "|";
    for (const TextTable::Entry& entry : row) {
      const std::string text = markdown_text(entry.text);
      out += " " + (entry.best ? "**" + text + "**" : text) + " |";
    }
    out += "\n";
  }
  return out;
}

std::string html_part(const TextTable& table) {
  std::string out = "<div class=\"wide\"><table><thead><tr>";
  for (const std::string& column : table.header) {
    out += "<th>";
    const std::vector<std::string> pieces = pieces_of(column);
    for (std::size_t i = 0; i < pieces.size(); ++i) out += (i ? "<wbr>" : "") + html_text(pieces[i]);
    out += "</th>";
  }
  out += "</tr></thead>\n";
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    out += i == table.ruled ? "<tr class=\"ruled\">" : "<tr>";
    for (const TextTable::Entry& entry : table.rows[i])
      out += (entry.best ? "<td class=\"best\">" : "<td>") + html_text(entry.text) + "</td>";
    out += "</tr>\n";
  }
  return out + "</table></div>\n";
}

// A column's name in lines no longer than they must be.
std::string latex_header(const std::string& text) {
  const std::vector<std::string> pieces = pieces_of(text);
  const std::size_t most = std::max<std::size_t>(8, longest(pieces));
  std::vector<std::string> lines;
  std::size_t length = 0;
  for (const std::string& piece : pieces) {
    if (lines.empty() || length + letters(piece) > most) lines.emplace_back(), length = 0;
    length += letters(piece);
    lines.back() += latex_text(piece);
  }
  return lines.size() == 1 ? lines[0] : "\\shortstack[r]{" + joined(lines, "\\\\") + "}";
}

std::string latex_part(const TextTable& table) {
  std::string out = "\\begin{tabular}{l" + std::string(table.header.size() - 1, 'r') + "}\n\\toprule\n";
  const auto line = [&](const std::vector<std::string>& parts) { out += joined(parts, " & ") + " \\\\\n"; };
  std::vector<std::string> header = {latex_text(table.header[0])};
  for (std::size_t c = 1; c < table.header.size(); ++c) header.push_back(latex_header(table.header[c]));
  line(header);
  out += "\\midrule\n";
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (i == table.ruled) out += "\\midrule\n";
    std::vector<std::string> parts;
    for (const TextTable::Entry& entry : table.rows[i])
      parts.push_back(entry.best ? "\\textbf{" + latex_text(entry.text) + "}" : latex_text(entry.text));
    line(parts);
  }
  return out + "\\bottomrule\n\\end{tabular}\n";
}

std::string written(const TextTable& table, std::string (*write)(const TextTable&), const char* between) {
  std::vector<std::string> parts;
  for (const TextTable& part : fitted(table)) parts.push_back(write(part));
  return joined(parts, between);
}

}  // namespace

TextTable transposed(const TextTable& table) {
  TextTable out{{table.header.front()}, {}};
  for (const auto& row : table.rows) out.header.push_back(row.front().text);
  for (std::size_t c = 1; c < table.header.size(); ++c) {
    out.rows.push_back({{table.header[c]}});
    for (const auto& row : table.rows) out.rows.back().push_back(row[c]);
  }
  return out;
}

std::vector<TextTable> fitted(const TextTable& table) {
  const TextTable other = transposed(table);
  const std::size_t width = width_of(table), other_width = width_of(other);
  if (width <= kPageLetters) return {table};
  if (other_width <= kPageLetters) return {other};
  return parts_of(width <= other_width ? table : other);
}

std::string markdown(const TextTable& table) { return written(table, markdown_part, "\n"); }
std::string html(const TextTable& table) { return written(table, html_part, ""); }
std::string latex(const TextTable& table) { return written(table, latex_part, "\n\n"); }

std::string short_text(double value) {
  if (!std::isfinite(value)) return "–";
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

std::string exact_text(double value, const char* otherwise) {
  if (!std::isfinite(value)) return otherwise;
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

std::string html_text(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
  return out;
}

std::string joined(const std::vector<std::string>& parts, const std::string& between) {
  std::string all;
  for (std::size_t i = 0; i < parts.size(); ++i) all += (i ? between : "") + parts[i];
  return all;
}

}  // namespace carve::experiments
