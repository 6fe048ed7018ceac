#include "report/text_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace carve::experiments {
namespace {

std::string latex_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (std::string("_%&#$").find(c) != std::string::npos) out += '\\';
    out += c;
  }
  const std::pair<std::string, std::string> signs[] = {
      {"–", "--"}, {"\u00a0", "~"}, {"−", "$-$"}, {"↓", "$\\downarrow$"}, {"↑", "$\\uparrow$"}, {"×", "$\\times$"}};
  for (const auto& [sign, code] : signs)
    for (std::size_t at; (at = out.find(sign)) != std::string::npos;) out.replace(at, sign.size(), code);
  return out;
}

}  // namespace

std::string markdown(const TextTable& table) {
  std::string out = "| " + joined(table.header, " | ") + " |\n|---|";
  for (std::size_t c = 1; c < table.header.size(); ++c) out += "---:|";
  out += "\n";
  for (const auto& row : table.rows) {
    out += "|";
    for (const TextTable::Entry& entry : row) out += " " + (entry.best ? "**" + entry.text + "**" : entry.text) + " |";
    out += "\n";
  }
  return out;
}

std::string html(const TextTable& table) {
  std::string out = "<div class=\"wide\"><table><thead><tr>";
  for (const std::string& column : table.header) {
    std::string text = html_text(column);
    for (std::size_t at = 0; (at = text.find('_', at)) != std::string::npos; at += 6) text.insert(at + 1, "<wbr>");
    out += "<th>" + text + "</th>";
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

std::string latex(const TextTable& table) {
  std::string out = "\\begin{tabular}{l" + std::string(table.header.size() - 1, 'r') + "}\n\\toprule\n";
  const auto line = [&](const std::vector<std::string>& parts) { out += joined(parts, " & ") + " \\\\\n"; };
  std::vector<std::string> header;
  for (const std::string& column : table.header) header.push_back(latex_text(column));
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

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string joined(const std::vector<std::string>& parts, const std::string& between) {
  std::string all;
  for (std::size_t i = 0; i < parts.size(); ++i) all += (i ? between : "") + parts[i];
  return all;
}

}  // namespace carve::experiments
