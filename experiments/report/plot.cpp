#include "report/plot.h"

#include <algorithm>
#include <boost/process.hpp>
#include <charconv>
#include <cmath>
#include <sstream>

#include "carve/core/error.h"
#include "carve/core/file.h"

namespace carve::experiments {
namespace bp = boost::process;
namespace fs = std::filesystem;
namespace {

std::string plain(double value) {
  if (!std::isfinite(value)) return "NaN";
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

// What gnuplot prints as it stands inside double quotes.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (c == '_' || c == '^' || c == '@' || c == '{' || c == '}') out += "\\\\";  // enhanced text would interpret them
    out += c;
  }
  return out + "\"";
}

bool is_number(const std::string& text) {
  double value = 0;
  return std::from_chars(text.data(), text.data() + text.size(), value).ptr == text.data() + text.size() &&
         !text.empty();
}

struct Data {
  std::vector<std::string> x;          // swept values or models
  std::vector<std::vector<double>> y;  // [x][method], NaN where there is none
  std::string x_name;
  bool lines = false, log_x = false;
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
  return data;
}

std::string csv_of(const Data& data, const Overview& overview) {
  std::string text = data.x_name.empty() ? "model" : data.x_name;
  for (const std::string& method : overview.methods) text += "," + method;
  text += "\n";
  for (std::size_t i = 0; i < data.x.size(); ++i) {
    std::string label = data.x[i];
    std::replace(label.begin(), label.end(), ',', ';');
    text += label;
    for (const double y : data.y[i]) text += "," + plain(y);
    text += "\n";
  }
  return text;
}

std::string script_of(const Data& data, const Overview& overview, const RunMetric& metric, const std::string& name) {
  std::ostringstream out;
  const std::size_t wide =
      data.lines ? 800 : std::clamp<std::size_t>(300 + data.x.size() * (overview.methods.size() * 9 + 22), 800, 2600);
  out << "# gnuplot " << name << ".gnuplot   redraws the figure from " << name << ".csv\n"
      << "set datafile separator ','\nset datafile missing 'NaN'\n"
      << "set title " << quoted(overview.title) << "\nset ylabel "
      << quoted(metric.name + (metric.unit.empty() ? "" : " (" + metric.unit + ")"))
      << "\nset key outside below horizontal\nset grid ytics lc rgb '#cccccc'\nset border 3\nset tics nomirror\n"
      // Okabe and Ito's colours: told apart by colour-blind readers, and by shape and dash on grey paper.
      << "array colour[8] = ['#0072B2', '#D55E00', '#009E73', '#CC79A7', '#E69F00', '#56B4E9', '#000000', '#999999']\n";
  const auto colour = [](std::size_t i) { return "rgb colour[" + std::to_string(i % 8 + 1) + "]"; };
  if (data.lines) {
    out << "set xlabel " << quoted(data.x_name) << "\n";
    if (data.log_x) out << "set logscale x 2\n";
    double low = INFINITY, high = 0;
    for (const auto& row : data.y)
      for (const double y : row)
        if (y > 0) low = std::min(low, y), high = std::max(high, y);
    if (high / low > 50) out << "set logscale y\nset format y '10^{%L}'\n";
    out << "set xtics (";
    for (std::size_t i = 0; i < data.x.size(); ++i) out << (i ? ", " : "") << data.x[i];
    out << ")\n";
  } else {
    out << "set style data histogram\nset style histogram clustered gap 1\nset style fill solid 0.9 border -1\n"
        << "set xtics rotate by -40 font ',9'\n";
    if (metric.better == Direction::lower) out << "set yrange [0:*]\n";
  }
  out << "do for [k = 1:3] {\n  if (k == 1) { set terminal svg size " << wide << ",480 font 'sans,12'; set output '"
      << name << ".svg' }\n"
      << "  if (k == 2) { set terminal pdfcairo size " << wide / 100.0 << ",4.8 font 'sans,12'; set output '" << name
      << ".pdf' }\n"
      << "  if (k == 3) { set terminal pngcairo size " << wide << ",480 font 'sans,12'; set output '" << name
      << ".png' }\n  plot ";
  for (std::size_t m = 0; m < overview.methods.size(); ++m) {
    out << (m ? ", \\\n    " : "") << (m ? "''" : "'" + name + ".csv'") << " skip 1 using ";
    if (data.lines)
      out << "1:" << m + 2 << " with linespoints lw 2 pt " << m % 7 + 4 << " dt " << m % 5 + 1 << " lc " << colour(m);
    else
      out << m + 2 << ":xtic(1) lc " << colour(m);
    out << " title " << quoted(overview.methods[m]);
  }
  out << "\n}\nset output\n";
  return out.str();
}

}  // namespace

void plot(const fs::path& folder, const std::string& name, const Overview& overview, const std::vector<Record>& records,
          const RunMetric& metric) {
  const Data data =
      overview.sweep.empty() ? model_data(overview, records, metric) : swept_data(overview, records, metric);
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
