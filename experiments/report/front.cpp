#include "report/front.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>
#include <set>
#include <tuple>

namespace carve::experiments {
namespace {

struct Counts {
  std::size_t runs = 0, done = 0, failed = 0, absent = 0, left = 0;
};

Counts counts_of(const Results& found) {
  Counts counts;
  counts.runs = found.overview.runs.size();
  for (const Record& record : found.records)
    ++(record.done() ? counts.done : record.status.starts_with(kNotInstalled) ? counts.absent : counts.failed);
  counts.left = counts.runs - found.records.size();
  return counts;
}

std::string counted(std::size_t number, const std::string& what) {
  return number == 0 ? "" : ", " + std::to_string(number) + " " + what;
}

// "Table 4.1" before "Table 4.10", tables before figures before sections.
auto place_of(const std::string& what) {
  std::vector<int> numbers;
  for (const char *at = what.data(), *end = at + what.size(); at < end;) {
    int number = 0;
    const auto read = std::from_chars(at, end, number);
    if (read.ec == std::errc()) numbers.push_back(number);
    at = read.ec == std::errc() ? read.ptr : at + 1;
  }
  return std::tuple(what.starts_with("Table") ? 0 : what.starts_with("Fig.") ? 1 : 2, numbers, what);
}

// The distinct values of a run's provenance, in the order of the runs.
std::vector<std::string> values_of(const NamedResults& specs, const std::string& key) {
  std::vector<std::string> values;
  for (const auto& [name, found] : specs)
    for (const Record& record : found.records)
      if (const auto at = record.provenance.find(key);
          at != record.provenance.end() && std::find(values.begin(), values.end(), at->second) == values.end())
        values.push_back(at->second);
  return values;
}

std::vector<std::string> commits_of(const NamedResults& specs) {
  constexpr std::size_t kShort = 10;
  std::vector<std::string> commits;
  for (const auto& [name, found] : specs)
    for (const Record& record : found.records) {
      const auto commit = record.provenance.find("commit"), dirty = record.provenance.find("dirty");
      if (commit == record.provenance.end()) continue;
      const bool changed = dirty != record.provenance.end() && dirty->second == "yes";
      const std::string text = commit->second.substr(0, kShort) + (changed ? " and changes not committed" : "");
      if (std::find(commits.begin(), commits.end(), text) == commits.end()) commits.push_back(text);
    }
  return commits;
}

std::vector<std::string> lines_of(const NamedResults& specs) {
  Counts all;
  for (const auto& [name, found] : specs) {
    const Counts own = counts_of(found);
    all = {all.runs + own.runs, all.done + own.done, all.failed + own.failed, all.absent + own.absent,
           all.left + own.left};
  }
  std::vector<std::string> lines = {
      std::to_string(specs.size()) + (specs.size() == 1 ? " experiment, " : " experiments, ") +
      std::to_string(all.done) + " of " + std::to_string(all.runs) + " runs have a result" +
      counted(all.failed, "failed") + counted(all.absent, "need what is not installed") +
      counted(all.left, "are not run yet") + "."};
  std::vector<std::string> dates = values_of(specs, "date");
  if (dates.empty()) return lines;
  const auto [first, last] = std::minmax_element(dates.begin(), dates.end());
  lines.push_back("Program: commit " + joined(commits_of(specs), ", ") + "; " +
                  joined(values_of(specs, "compiler"), ", ") + ". Runs from " + *first + " to " + *last + ".");
  lines.push_back("Machine: " + joined(values_of(specs, "cpu"), ", ") + ", " + joined(values_of(specs, "cores"), ", ") +
                  " cores.");
  return lines;
}

}  // namespace

std::string anchor_of(const PublishedTable& table) {
  std::string anchor = table.title.substr(0, table.title.find(':'));
  for (char& c : anchor) c = std::isalnum(static_cast<unsigned char>(c)) ? static_cast<char>(std::tolower(c)) : '-';
  return anchor;
}

NamedResults load_all(const std::filesystem::path& results) {
  NamedResults all;
  for (const std::string& name : specs_in(results)) all.emplace_back(name, load_results(results / name));
  const auto place = [](const std::vector<std::string>& thesis) {  // of its first table or figure; none: last
    std::set<decltype(place_of(""))> places;
    for (const std::string& what : thesis) places.insert(place_of(what));
    return std::pair(places.empty(), places);
  };
  std::stable_sort(all.begin(), all.end(), [&](const auto& a, const auto& b) {
    return place(a.second.overview.thesis) < place(b.second.overview.thesis);
  });
  return all;
}

Front front_of(const NamedResults& specs, const std::vector<PublishedTable>& published) {
  Front front{
      lines_of(specs), {{"experiment", "of the thesis", "runs", "done", "failed", "not installed", "not run"}, {}}, {}};
  std::map<std::string, std::vector<std::string>> places;
  for (const PublishedTable& table : published)
    places[table.title.substr(0, table.title.find(':'))].push_back(anchor_of(table));
  for (const auto& [name, found] : specs) {
    const Counts own = counts_of(found);
    front.runs.rows.push_back({{name}, {joined(found.overview.thesis, ", ")}});
    for (const std::size_t count : {own.runs, own.done, own.failed, own.absent, own.left})
      front.runs.rows.back().push_back({std::to_string(count)});
    for (const std::string& what : found.overview.thesis) places[what].push_back(name);
  }
  for (const auto& [what, anchors] : places) front.thesis.push_back({what, anchors});
  std::sort(front.thesis.begin(), front.thesis.end(),
            [](const Front::Place& a, const Front::Place& b) { return place_of(a.what) < place_of(b.what); });
  return front;
}

}  // namespace carve::experiments
