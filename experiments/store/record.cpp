#include "store/record.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "carve/core/error.h"
#include "carve/core/file.h"

namespace carve::experiments {
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

constexpr const char* kDirections[] = {"lower", "higher", "none"};

// The fields of each file, for its writer and its reader.
template <class R, class Visitor>
requires std::is_same_v<std::remove_const_t<R>, Record>
void visit(R& r, Visitor&& field) {
  field("id", r.id);
  field("status", r.status);
  field("spec", r.spec);
  field("model", r.model);
  field("method", r.method);
  field("arm", r.arm);
  field("seed", r.seed);
  field("swept", r.swept);
  field("settings", r.settings);
  field("metrics", r.metrics);
  field("provenance", r.provenance);
}

template <class O, class Visitor>
requires std::is_same_v<std::remove_const_t<O>, Overview>
void visit(O& o, Visitor&& field) {
  field("spec", o.spec);
  field("title", o.title);
  field("thesis", o.thesis);
  field("baseline", o.baseline);
  field("models", o.models);
  field("methods", o.methods);
  field("metrics", o.metrics);
  field("sweep", o.sweep);
  field("runs", o.runs);
  field("heat_map_models", o.heat_map_models);
  field("heat_map_range", o.heat_map_range);
  field("render_models", o.render_models);
  field("published", o.published.table);
  field("published_method", o.published.method);
  field("published_columns", o.published.columns);
}

template <class T>
std::string written(const T& value) {
  Json json;
  visit(value, [&](const char* name, const auto& field) { json[name] = field; });
  return json.dump(1) + "\n";
}

void read_field(const Json& json, std::map<std::string, double>& values) {
  for (const auto& [name, value] : json.items())
    if (value.is_number()) values[name] = value;  // null: a metric that has no value here
}

template <class T>
void read_field(const Json& json, T& value) {
  json.get_to(value);
}

template <class T>
T read(const std::string& text, const std::string& path, const char* what) {
  try {
    const Json json = Json::parse(text);
    T value;
    visit(value, [&](const char* name, auto& field) { read_field(json.at(name), field); });
    return value;
  } catch (const nlohmann::json::exception& error) {
    throw IoError(path, "not " + std::string(what) + ": " + error.what());
  }
}

}  // namespace

// Found by the JSON library, by these names.
static void to_json(Json& json, const RunMetric& m) {
  json = {
      {"name", m.name}, {"formula", m.formula}, {"unit", m.unit}, {"better", kDirections[static_cast<int>(m.better)]}};
}

static void from_json(const Json& json, RunMetric& m) {
  const auto direction =
      std::find(std::begin(kDirections), std::end(kDirections), json.at("better").get<std::string>());
  m = {json.at("name"), json.at("formula"), json.at("unit"),
       direction == std::end(kDirections) ? Direction::none : static_cast<Direction>(direction - kDirections)};
}

std::string text_of(const Settings& settings) {
  std::string text;
  for (const auto& [field, value] : settings) text += (text.empty() ? "" : ",") + field + "=" + value;
  return text;
}

std::string to_json(const Record& r) { return written(r); }
std::string to_json(const Overview& o) { return written(o); }

Record record_from_json(const std::string& text, const std::string& path) {
  return read<Record>(text, path, "a run record");
}

Overview overview_from_json(const std::string& text, const std::string& path) {
  return read<Overview>(text, path, "an overview of results");
}

std::vector<Record> load_records(const fs::path& folder, std::vector<std::string>& complaints) {
  std::vector<fs::path> files;
  std::error_code none;
  for (fs::recursive_directory_iterator entry(folder, none), end; entry != end; entry.increment(none))
    if (entry->path().filename() == kRecordFile) files.push_back(entry->path());
  std::sort(files.begin(), files.end());
  std::vector<Record> records;
  for (const fs::path& file : files) {
    try {
      records.push_back(record_from_json(read_file(file), file.string()));
      records.back().folder = file.parent_path().lexically_relative(folder.parent_path()).string();
    } catch (const IoError& error) {
      complaints.push_back(error.what());
    }
  }
  return records;
}

Overview load_overview(const fs::path& folder) {
  const fs::path file = folder / kOverviewFile;
  return overview_from_json(read_file(file), file.string());
}

namespace {

void name_stages(Overview& overview, const std::vector<Record>& records) {
  std::vector<RunMetric> named;
  const auto known = [&](const std::string& name, const std::vector<RunMetric>& metrics) {
    return std::any_of(metrics.begin(), metrics.end(), [&](const RunMetric& m) { return m.name == name; });
  };
  const auto measured = [&](const std::string& name) {
    return std::any_of(records.begin(), records.end(), [&](const Record& r) { return r.metrics.contains(name); });
  };
  const bool every_stage = known(kEveryStage, overview.metrics);
  const std::string_view stage = std::string_view(kEveryStage).substr(0, std::string_view(kEveryStage).size() - 1);
  for (const RunMetric& metric : overview.metrics) {
    if (metric.name != kEveryStage) {
      if (!every_stage || !metric.name.starts_with(stage) || measured(metric.name)) named.push_back(metric);
      continue;
    }
    for (const Record& record : records)
      for (const auto& [name, value] : record.metrics)
        if (name.starts_with(stage) && !known(name, named) && !known(name, overview.metrics))
          named.push_back({name, "wall time of the stage " + name.substr(stage.size()) + ", one thread", metric.unit,
                           metric.better});
  }
  overview.metrics = std::move(named);
}

// What an earlier text of the spec left behind must not stand among the runs of this one.
void leave_out_others(Results& results) {
  const std::set<std::string> runs(results.overview.runs.begin(), results.overview.runs.end());
  const std::size_t others = std::erase_if(results.records, [&](const Record& r) { return !runs.contains(r.folder); });
  if (others > 0)
    results.complaints.push_back(results.overview.spec + ": " + std::to_string(others) +
                                 " runs left out that the spec no longer has");
}

std::vector<Record> in_every_row(std::vector<Record> records, const std::vector<std::string>& sweep) {
  for (const std::string& field : sweep) {
    std::set<std::string> values;
    for (const Record& record : records)
      if (const auto found = record.swept.find(field); found != record.swept.end()) values.insert(found->second);
    std::vector<Record> all;
    for (const Record& record : records) {
      if (record.swept.contains(field) || values.empty()) {
        all.push_back(record);
        continue;
      }
      for (const std::string& value : values) {
        all.push_back(record);
        all.back().swept[field] = value;
      }
    }
    records = std::move(all);
  }
  return records;
}

}  // namespace

Results load_results(const fs::path& folder) {
  Results results;
  results.overview = load_overview(folder);
  results.records = load_records(folder, results.complaints);
  leave_out_others(results);
  name_stages(results.overview, results.records);
  std::erase_if(results.overview.sweep, [&](const std::string& field) {  // of which no run is there yet
    return std::none_of(results.records.begin(), results.records.end(),
                        [&](const Record& r) { return r.swept.contains(field); });
  });
  results.rows = in_every_row(results.records, results.overview.sweep);
  return results;
}

std::vector<std::string> specs_in(const fs::path& results) {
  std::vector<std::string> names;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(results, none))
    if (fs::exists(entry.path() / kOverviewFile)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace carve::experiments
