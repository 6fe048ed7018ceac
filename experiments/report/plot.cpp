#include "report/plot.h"

#include <algorithm>
#include <boost/process.hpp>
#include <charconv>
#include <cmath>
#include <sstream>

#include "carve/core/error.h"
#include "carve/core/file.h"
#include "eval/report.h"

namespace carve::experiments {
namespace bp = boost::process;
namespace fs = std::filesystem;
namespace {

// What gnuplot prints as it stands inside double quotes.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

bool is_number(const std::string& text) {
  double value = 0;
  return std::from_chars(text.data(), text.data() + text.size(), value).ptr == text.data() + text.size() &&
         !text.empty();
}

// Wider tables than this are drawn as dots, a line a row: bars would be too thin to tell apart.
constexpr std::size_t kMostBars = 36;
constexpr std::size_t kMostRows = 30;  // more are no page any more: only how they spread is drawn

struct Data {
  std::vector<std::string> x;          // swept values or models
  std::vector<std::vector<double>> y;  // [x][method], NaN where there is none
  std::string x_name;
  bool lines = false, dots = false, spread = false, log_x = false;
};

// Per value of the first swept field, the mean over the rows that every method has.
Data swept_data(const Overview& overview, const std::vector<Record>& records, const RunMetric& metric) {
  const std::string& field = overview.sweep.front();
  Data data;
  data.x_name = field;
  for (const Record& r : records)
    if (const std::string& v = r.swept.at(field); std::find(data.x.begin(), data.x.end(), v) == data.x.end())
      data.x.push_back(v);
  const bool numbers = std::all_of(data.x.begin(), data.x.end(), is_number);
  if (numbers)
    std::sort(data.x.begin(), data.x.end(), [](const auto& a, const auto& b) { return std::stod(a) < std::stod(b); });
  data.lines = numbers;
  data.log_x = numbers && data.x.size() > 2 && std::stod(data.x.front()) > 0 &&
               std::stod(data.x.back()) / std::stod(data.x.front()) >= 8;
  for (const std::string& value : data.x) {
    std::vector<Record> part;
    std::copy_if(records.begin(), records.end(), std::back_inserter(part),
                 [&](const Record& r) { return r.swept.at(field) == value; });
    const Table table = make_table(overview, part, metric);
    data.y.emplace_back();
    for (const Table::Summary& summary : table.summaries) data.y.back().push_back(summary.mean);
  }
  return data;
}

Data model_data(const Overview& overview, const std::vector<Record>& records, const RunMetric& metric) {
  const Table table = make_table(overview, records, metric);
  Data data;
  for (const Table::Row& row : table.rows) {
    data.x.push_back(row.label);
    data.y.emplace_back();
    for (const Table::Entry& entry : row.entries) data.y.back().push_back(entry.value.value_or(std::nan("")));
  }
  data.spread = data.x.size() > kMostRows && overview.methods.size() > 1 && !overview.baseline.empty();
  data.dots = !data.spread && data.x.size() * overview.methods.size() > kMostBars;
  return data;
}

std::string csv_of(const Data& data, const Overview& overview) {
  std::string text = data.x_name.empty() ? "model" : data.x_name;
  for (const std::string& method : overview.methods) text += "," + csv_text(method);
  text += "\n";
  for (std::size_t i = 0; i < data.x.size(); ++i) {
    text += csv_text(data.x[i]);
    for (const double y : data.y[i]) text += "," + exact_text(y, "NaN");
    text += "\n";
  }
  return text;
}

struct Layout {
  std::size_t width = 640, height = 380, key_columns = 1, key_height = 0;
};

// The key stands above the axes, in as many columns as its longest name leaves room for.
Layout layout_of(const Data& data, const Overview& overview) {
  Layout layout;
  std::size_t longest = 1;
  for (const std::string& method : overview.methods) longest = std::max(longest, method.size());
  const std::size_t count = overview.methods.size();
  layout.key_columns = std::clamp<std::size_t>((layout.width - 140) / (9 * longest + 70), 1, count);
  if (data.spread) return {.height = 480, .key_height = 14};
  layout.key_height = 10 + 19 * ((count + layout.key_columns - 1) / layout.key_columns);
  if (data.dots) layout.height = 70 + data.x.size() * std::max<std::size_t>(15, 4 * count);
  layout.height += layout.key_height;
  return layout;
}

std::string axis_of(const RunMetric& metric) {
  return metric.name + (metric.unit.empty() ? "" : " (" + metric.unit + ")");
}

double largest_over_smallest(const Data& data) {
  double low = INFINITY, high = 0;
  for (const auto& row : data.y)
    for (const double y : row)
      if (y > 0) low = std::min(low, y), high = std::max(high, y);
  return high / low;
}

// A box a method but the baseline.
std::string spread_axes(const Overview& overview, const RunMetric& metric) {
  std::ostringstream out;
  out << "set ylabel " << quoted(axis_of(metric) + " - " + overview.baseline)
      << "\nset grid ytics lt 1 lw 0.5 lc rgb '#c8c8c8'\nset xzeroaxis lt 1 lw 1 lc rgb '#8c8c8c'\n"
      << "set style data boxplot\nset style boxplot outliers pointtype 6\nset style fill solid 0.4 border -1\n"
      << "set boxwidth 0.5\nunset key\nset rmargin 8\nset xtics rotate by -35 font ',10' (";
  const char* comma = "";
  for (std::size_t m = 0; m < overview.methods.size(); ++m) {
    if (overview.methods[m] == overview.baseline) continue;
    out << comma << quoted(overview.methods[m]) << " " << m;
    comma = ", ";
  }
  out << ")\n";
  return out.str();
}

std::string spread_curves(const Overview& overview, const std::string& name) {
  const auto column = [](std::size_t m) { return "column(" + std::to_string(m + 2) + ")"; };
  const auto base = std::find(overview.methods.begin(), overview.methods.end(), overview.baseline);
  std::string curves;
  for (std::size_t m = 0; m < overview.methods.size(); ++m)
    if (overview.methods[m] != overview.baseline)
      curves += (curves.empty() ? "'" + name + ".csv'" : ", \\\n    ''") + " skip 1 using (" + std::to_string(m) +
                "):(" + column(m) + " - " + column(base - overview.methods.begin()) + ") lc rgb colour[" +
                std::to_string(m % 7 + 1) + "]";
  return curves;
}

// Axes of lines over a swept field, of bars, or of dots.
std::string axes_of(const Data& data, const RunMetric& metric) {
  std::ostringstream out;
  const char value_axis = data.dots ? 'x' : 'y';
  out << "set " << value_axis << "label " << quoted(axis_of(metric)) << "\nset grid " << value_axis
      << "tics lt 1 lw 0.5 lc rgb '#c8c8c8'\n";
  if (metric.unit == "s" && largest_over_smallest(data) > 20)
    out << "set logscale " << value_axis << "\nset format " << value_axis << " '%g'\n";
  else if (metric.better == Direction::lower || !(data.lines || data.dots))  // bars stand on nothing
    out << "set " << value_axis << "range [*<0:*]\n";
  if (data.lines) {
    out << "set xlabel " << quoted(data.x_name) << "\n" << (data.log_x ? "set logscale x 2\n" : "") << "set xtics (";
    for (std::size_t i = 0; i < data.x.size(); ++i) out << (i ? ", " : "") << data.x[i];
    const double first = std::stod(data.x.front()), last = std::stod(data.x.back()), room = 0.02 * (last - first);
    out << ")\nset xrange [" << exact_text(data.log_x ? first / 1.03 : first - room) << ":"
        << exact_text(data.log_x ? last * 1.03 : last + room) << "]\n";
  } else if (data.dots) {
    out << "set yrange [" << data.x.size() << " - 0.5:-0.5]\nset grid ytics\nset ytics font ',9' (";
    for (std::size_t i = 0; i < data.x.size(); ++i) out << (i ? ", " : "") << quoted(data.x[i]) << " " << i;
    out << ")\n";
  } else {
    out << "set style data histogram\nset style histogram clustered gap 1\nset style fill solid 1 border -1\n"
        << "set xtics rotate by -35 font ',10'\nset rmargin 8\n";
  }
  return out.str();
}

std::string curves_of(const Data& data, const Overview& overview, const std::string& name) {
  std::ostringstream out;
  const std::size_t count = overview.methods.size();
  std::size_t coloured = 0;
  for (std::size_t m = 0; m < count; ++m) {
    const bool base = overview.methods[m] == overview.baseline;
    const std::string colour = base ? "rgb '#8c8c8c'" : "rgb colour[" + std::to_string(coloured % 7 + 1) + "]";
    const std::size_t shape = (coloured + coloured / 7) % 7 + 4;  // no two methods have both colour and shape in common
    coloured += !base;
    out << (m ? ", \\\n    " : "") << (m ? "''" : "'" + name + ".csv'") << " skip 1 using ";
    if (data.lines)
      out << "1:" << m + 2 << " with linespoints lw 2 pt " << shape << " dt " << m % 5 + 1 << " lc " << colour;
    else if (data.dots)
      out << m + 2 << ":($0 + "
          << (static_cast<double>(m) - (static_cast<double>(count) - 1) / 2) * 0.6 / static_cast<double>(count)
          << ") with points pt " << shape << " ps 0.9 lw 1.5 lc " << colour;
    else
      out << m + 2 << ":xtic(1) lc " << colour;
    out << " title " << quoted(overview.methods[m]);
  }
  return out.str();
}

std::string script_of(const Data& data, const Overview& overview, const RunMetric& metric, const std::string& name) {
  std::ostringstream out;
  const Layout size = layout_of(data, overview);
  out << "# " << overview.title << "\n# gnuplot " << name << ".gnuplot   redraws the figure from " << name << ".csv\n"
      << "set datafile separator ','\nset datafile missing 'NaN'\n"
      << "set key at screen 0.5, screen 1 top center horizontal maxcols " << size.key_columns
      << "\nset tmargin at screen "
      << exact_text(1 - static_cast<double>(size.key_height) / static_cast<double>(size.height))
      << "\nset border 3\nset tics nomirror\n"
      // Okabe and Ito's colours: told apart by colour-blind readers, and by shape and dash on grey paper. The baseline
      // is grey.
      << "array colour[7] = ['#0072B2', '#D55E00', '#009E73', '#CC79A7', '#E69F00', '#56B4E9', '#000000']\n"
      << (data.spread ? spread_axes(overview, metric) : axes_of(data, metric)) << "do for [k = 1:3] {\n";
  const auto terminal = [&](int k, const char* kind, const std::string& dimensions, const char* ending) {
    out << "  if (k == " << k << ") { set terminal " << kind << " noenhanced size " << dimensions
        << " font 'sans,12'; set output '" << name << ending << "' }\n";
  };
  const std::string pixels = std::to_string(size.width) + "," + std::to_string(size.height);
  terminal(1, "svg", pixels, ".svg");
  terminal(2, "pdfcairo", exact_text(size.width / 100.0) + "," + exact_text(size.height / 100.0), ".pdf");
  terminal(3, "pngcairo", pixels, ".png");
  out << "  plot " << (data.spread ? spread_curves(overview, name) : curves_of(data, overview, name))
      << "\n}\nset output\n";
  return out.str();
}

}  // namespace

void plot(const fs::path& folder, const std::string& name, const Overview& overview, const std::vector<Record>& records,
          const RunMetric& metric) {
  const Data data =
      overview.sweep.empty() ? model_data(overview, records, metric) : swept_data(overview, records, metric);
  const auto drawn = [](const std::vector<double>& row) {
    return std::any_of(row.begin(), row.end(), [](double y) { return std::isfinite(y); });
  };
  if (std::none_of(data.y.begin(), data.y.end(), drawn)) return;
  fs::create_directories(folder);
  write_file(folder / (name + ".csv"), [&](std::ostream& out) { out << csv_of(data, overview); });
  write_file(folder / (name + ".gnuplot"), [&](std::ostream& out) { out << script_of(data, overview, metric, name); });
  const auto program = bp::search_path("gnuplot");
  if (program.empty())
    throw NoResult("gnuplot is not installed: the figures of " + (folder / name).string() + " were not drawn");
  bp::ipstream errors;
  const int code = bp::system(program, name + ".gnuplot", bp::start_dir = folder.string(),
                              bp::std_in<bp::null, bp::std_out> bp::null, bp::std_err > errors);
  if (code != 0) {
    std::string line;
    std::getline(errors, line);
    std::string next;
    while (std::getline(errors, next))
      if (!next.empty()) line = next;
    throw NoResult("gnuplot failed on " + (folder / name).string() + ".gnuplot: " + line);
  }
}

}  // namespace carve::experiments
