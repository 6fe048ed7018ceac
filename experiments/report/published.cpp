#include "report/published.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <sstream>

#include "carve/core/error.h"
#include "carve/core/file.h"
#include "report/statistics.h"
#include "store/record.h"

namespace carve::experiments {
namespace fs = std::filesystem;
namespace {

using Row = std::map<std::string, std::string>;  // by column; the tables have no quoted fields
using Rows = std::vector<Row>;

// Differences below these are rounding: sums and means of values printed to a minute or a hundredth of a second.
constexpr double kRoundedMinutes = 2, kRoundedSeconds = 0.0201;

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> parts;
  std::istringstream in(line);
  for (std::string part; std::getline(in, part, ',');) parts.push_back(part);
  return parts;
}

Rows read_csv(const fs::path& file) {
  std::istringstream in(read_file(file));
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> header = split(line);
  Rows rows;
  while (std::getline(in, line)) {
    const std::vector<std::string> parts = split(line);
    if (parts.size() != header.size())
      throw IoError(file.string(), "a row must have " + std::to_string(header.size()) + " fields: " + line);
    rows.emplace_back();
    for (std::size_t c = 0; c < header.size(); ++c) rows.back()[header[c]] = parts[c];
  }
  return rows;
}

double number(const Row& row, const std::string& column) {
  const std::string& text = row.at(column);
  double value = 0;
  if (std::from_chars(text.data(), text.data() + text.size(), value).ptr != text.data() + text.size())
    throw IoError("published tables", column + " must be a number, got " + text);
  return value;
}

double minutes(const Row& row, const std::string& column) {
  const std::string& text = row.at(column);
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) throw IoError("published tables", column + " must be hh:mm, got " + text);
  return 60 * std::stod(text.substr(0, colon)) + std::stod(text.substr(colon + 1));
}

std::string fixed(double value, int decimals) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, decimals).ptr;
  return {text, end};
}

std::string clock(double all_minutes) {
  const double whole = std::floor(all_minutes / 60), rest = all_minutes - 60 * whole;
  const bool round = rest == std::floor(rest);
  return fixed(whole, 0) + (rest < 10 ? ":0" : ":") + fixed(rest, round ? 0 : 1);
}

std::string percent(double share) { return fixed(100 * share, 1) + " %"; }

double speed_up(double from_scratch, double coarse_given) { return 1 - coarse_given / from_scratch; }

// What our runs measured for a row of a published table.
class Measured {
 public:
  Measured(const std::string& table, const fs::path& results) {
    for (const std::string& name : specs_in(results))
      if (Results found = load_results(results / name); found.overview.published.table == table) {
        published_ = found.overview.published;
        records_ = std::move(found.records);
        title_ = found.overview.title;
      }
  }
  const Published& published() const { return published_; }
  // What else the machine was doing: "0.1 to 0.3 on 2 cores".
  std::string load() const {
    std::vector<std::string> loads;
    for (const Record& r : records_)
      if (const auto found = r.provenance.find("load"); found != r.provenance.end()) loads.push_back(found->second);
    if (loads.empty()) return "unknown";
    const auto less = [](const std::string& a, const std::string& b) {
      return std::atof(a.c_str()) < std::atof(b.c_str());
    };
    const auto [low, high] = std::minmax_element(loads.begin(), loads.end(), less);
    const auto cores = records_.front().provenance.find("cores");
    return *low + " to " + *high +
           (cores == records_.front().provenance.end() ? "" : " on " + cores->second + " cores");
  }
  const std::string& title() const { return title_; }

  double operator()(const std::string& row, const std::string& column) const {
    const auto metric = published_.columns.find(column);
    if (metric == published_.columns.end()) return std::nan("");
    std::vector<double> values;
    for (const Record& r : records_) {
      const bool is = published_.method.empty() ? r.method == row : r.model == row && r.method == published_.method;
      if (const auto found = r.metrics.find(metric->second); is && r.done() && found != r.metrics.end())
        values.push_back(found->second);
    }
    return mean(values);
  }

 private:
  Published published_;
  std::vector<Record> records_;
  std::string title_;
};

// The thesis's sentences about a figure beside what its tables give.
void add_claims(const Rows& claims, const std::string& quantity, const std::string& computed,
                std::vector<std::string>& notes) {
  std::string said;
  for (const Row& claim : claims)
    if (claim.at("quantity") == quantity)
      said += (said.empty() ? "" : ", ") + claim.at("percent") + " % (" + claim.at("where") + ")";
  notes.push_back(quantity + ": " + computed + "; the text says " + said);
}

PublishedTable table_4_1(const Rows& rows, const Rows& claims, const fs::path& results) {
  const Measured measured("table_4_1", results);
  PublishedTable out{"Table 4.1: surface distance to the ground truth", {{"method", "published"}, {}}, {}};
  const bool any = !measured.title().empty();
  if (any) out.table.header.push_back("measured, " + measured.published().columns.at("error"));
  std::map<std::string, double> errors, ours;
  for (const Row& row : rows) {
    const std::string& method = row.at("method");
    errors[method] = number(row, "error");
    out.table.rows.push_back({{method}, {row.at("error")}});
    ours[method] = measured(method, "error");
    if (any) out.table.rows.back().push_back({std::isfinite(ours[method]) ? short_text(ours[method]) : "–"});
  }
  add_claims(claims, "accuracy over CMVS",
             "the table gives " + percent(speed_up(errors.at("CMVS"), errors.at("ours"))) +
                 (any && std::isfinite(ours["CMVS"] + ours["ours"])
                      ? ", ours measured " + percent(speed_up(ours["CMVS"], ours["ours"]))
                      : ""),
             out.notes);
  out.notes.push_back("the thesis names neither the object nor the length that the errors are shares of" +
                      std::string(any ? "; measured: " + measured.title() : "; not measured in these results"));
  return out;
}

using Times = std::map<std::pair<std::string, std::string>, std::pair<double, double>>;  // object, measure -> minutes

Times mean_of_artists(const Rows& rows) {
  std::map<std::pair<std::string, std::string>, std::pair<std::vector<double>, std::vector<double>>> all;
  for (const Row& row : rows) {
    auto& [scratch, coarse] = all[{row.at("object"), row.at("measure")}];
    scratch.push_back(minutes(row, "from_scratch"));
    coarse.push_back(minutes(row, "coarse_given"));
  }
  Times means;
  for (const auto& [key, times] : all) means[key] = {mean(times.first), mean(times.second)};
  return means;
}

void add_sums(const Times& times, const std::string& whose, std::vector<std::string>& notes) {
  for (const auto& [key, total] : times) {
    if (key.second != "total") continue;
    const auto modeling = times.find({key.first, "modeling"}), texturing = times.find({key.first, "texturing"});
    if (modeling == times.end() || texturing == times.end()) continue;
    const double scratch = modeling->second.first + texturing->second.first,
                 coarse = modeling->second.second + texturing->second.second;
    if (std::abs(scratch - total.first) >= kRoundedMinutes)
      notes.push_back(whose + key.first + ": modeling and texturing from scratch make " + clock(scratch) +
                      ", the total is given as " + clock(total.first));
    if (std::abs(coarse - total.second) >= kRoundedMinutes)
      notes.push_back(whose + key.first + ": modeling and texturing of a coarse model make " + clock(coarse) +
                      ", the total is given as " + clock(total.second));
  }
}

PublishedTable table_4_2(const Rows& rows, const Rows& appendix, const Rows& claims) {
  PublishedTable out{
      "Table 4.2: times of four artists (hh:mm), recomputed from Appendix B",
      {{"object, measure", "from scratch", "B", "coarse given", "B", "speed-up printed", "of printed times", "of B"},
       {}},
      {}};
  const Times means = mean_of_artists(appendix);
  Times printed;
  std::map<std::string, std::vector<double>> printed_share, share_of_times, share_of_b;
  for (const Row& row : rows) {
    const std::string &object = row.at("object"), &measure = row.at("measure"), name = object + ", " + measure;
    const double scratch = minutes(row, "from_scratch"), coarse = minutes(row, "coarse_given");
    printed[{object, measure}] = {scratch, coarse};
    const auto [b_scratch, b_coarse] = means.at({object, measure});
    const double said = number(row, "speed_up_percent") / 100, of_times = speed_up(scratch, coarse),
                 of_b = speed_up(b_scratch, b_coarse);
    printed_share[measure].push_back(said);
    share_of_times[measure].push_back(of_times);
    share_of_b[measure].push_back(of_b);
    out.table.rows.push_back({{name},
                              {clock(scratch)},
                              {clock(b_scratch)},
                              {clock(coarse)},
                              {clock(b_coarse)},
                              {row.at("speed_up_percent") + " %"},
                              {percent(of_times)},
                              {percent(of_b)}});
    if (std::abs(of_times - said) > 0.0101)
      out.notes.push_back(name + ": " + fixed(100 * said, 0) + " % is printed, the printed times give " +
                          percent(of_times) + ", Appendix B " + percent(of_b));
    if (std::abs(scratch - b_scratch) >= kRoundedMinutes)
      out.notes.push_back(name + " from scratch: " + clock(scratch) + " is printed, Appendix B's mean is " +
                          clock(b_scratch));
    if (std::abs(coarse - b_coarse) >= kRoundedMinutes)
      out.notes.push_back(name + ", coarse given: " + clock(coarse) + " is printed, Appendix B's mean is " +
                          clock(b_coarse));
  }
  add_sums(printed, "Table 4.2, ", out.notes);
  for (const auto& [measure, title] :
       {std::pair("modeling", "speed-up of modeling"), std::pair("total", "speed-up in total")})
    add_claims(claims, title,
               "the mean of the printed shares is " + percent(mean(printed_share[measure])) +
                   ", of the printed times " + percent(mean(share_of_times[measure])) + ", of Appendix B " +
                   percent(mean(share_of_b[measure])),
               out.notes);
  std::map<std::string, Rows> artists;
  for (const Row& row : appendix) artists[row.at("artist")].push_back(row);
  for (const auto& [artist, own] : artists) add_sums(mean_of_artists(own), "Table B." + artist + ", ", out.notes);
  out.notes.push_back("people's times: there is no measured counterpart");
  return out;
}

// A total is set beside another only where it is of the same steps.
bool all_steps(const Measured& measured, const std::string& object) {
  return std::isfinite(measured(object, "volume") + measured(object, "mesh") + measured(object, "texture"));
}

PublishedTable table_4_3(const Rows& rows, const fs::path& results) {
  const Measured measured("table_4_3", results);
  PublishedTable out{"Table 4.3: seconds per step at grid 128", {{"object"}, {}}, {}};
  const char* const columns[] = {"volume", "mesh", "texture", "total"};
  for (const char* column : columns) {
    out.table.header.push_back(column);
    if (measured.published().columns.contains(column))
      out.table.header.insert(out.table.header.end(), {"measured", "ratio"});
  }
  std::map<std::string, std::vector<double>> printed, ours;
  for (const Row& row : rows) {
    const std::string& object = row.at("object");
    const bool average = object == "average";
    if (average) out.table.ruled = out.table.rows.size();
    out.table.rows.push_back({{object}});
    for (const char* column : columns) {
      out.table.rows.back().push_back({row.at(column)});
      const double said = number(row, column);
      if (average) {
        if (std::abs(mean(printed[column]) - said) > kRoundedSeconds)
          out.notes.push_back("average of " + std::string(column) + ": " + row.at(column) +
                              " is printed, the rows give " + fixed(mean(printed[column]), 2));
      } else {
        printed[column].push_back(said);
      }
      if (!measured.published().columns.contains(column)) continue;
      double value = average ? mean(ours[column]) : measured(object, column);
      if (column == columns[3] && !average && !all_steps(measured, object)) value = std::nan("");
      if (!average && std::isfinite(value)) ours[column].push_back(value);
      out.table.rows.back().push_back({std::isfinite(value) ? short_text(value) : "–"});
      out.table.rows.back().push_back(
          {std::isfinite(value) ? fixed(said / value, said / value < 10 ? 1 : 0) + " ×" : "–"});
    }
    const double sum = number(row, "volume") + number(row, "mesh") + number(row, "texture");
    if (std::abs(sum - number(row, "total")) > kRoundedSeconds)
      out.notes.push_back(object + ": the steps make " + fixed(sum, 2) + ", the total is given as " + row.at("total"));
  }
  out.notes.push_back(measured.title().empty()
                          ? "not measured in these results"
                          : "published: i7-4510U at 2.00 GHz; measured: " + measured.title() + ", one thread, load " +
                                measured.load() +
                                " when the runs began (above one a core times are longer than the work); the objects "
                                "are our stand-ins");
  return out;
}

}  // namespace

std::vector<PublishedTable> published_tables(const fs::path& folder, const fs::path& results) {
  if (folder.empty()) return {};
  const Rows claims = read_csv(folder / "claims.csv");
  return {table_4_1(read_csv(folder / "table_4_1.csv"), claims, results),
          table_4_2(read_csv(folder / "table_4_2.csv"), read_csv(folder / "table_b.csv"), claims),
          table_4_3(read_csv(folder / "table_4_3.csv"), results)};
}

}  // namespace carve::experiments
