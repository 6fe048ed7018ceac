#include "store/record.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "carve/core/error.h"
#include "carve/core/file.h"

namespace carve::experiments {
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

constexpr const char* kDirections[] = {"lower", "higher", "none"};

Json json_of(const RunMetric& m) {
  return {
      {"name", m.name}, {"formula", m.formula}, {"unit", m.unit}, {"better", kDirections[static_cast<int>(m.better)]}};
}

RunMetric metric_from(const Json& json) {
  const auto direction =
      std::find(std::begin(kDirections), std::end(kDirections), json.at("better").get<std::string>());
  return {json.at("name"), json.at("formula"), json.at("unit"),
          direction == std::end(kDirections) ? Direction::none : static_cast<Direction>(direction - kDirections)};
}

}  // namespace

std::string text_of(const Settings& settings) {
  std::string text;
  for (const auto& [field, value] : settings) text += (text.empty() ? "" : ",") + field + "=" + value;
  return text;
}

std::string to_json(const Record& r) {
  const Json json = {{"id", r.id},           {"status", r.status},        {"spec", r.spec},
                     {"model", r.model},     {"method", r.method},        {"arm", r.arm},
                     {"seed", r.seed},       {"swept", r.swept},          {"settings", r.settings},
                     {"metrics", r.metrics}, {"provenance", r.provenance}};
  return json.dump(1) + "\n";
}

std::string to_json(const Overview& o) {
  Json metrics = Json::array();
  for (const RunMetric& metric : o.metrics) metrics.push_back(json_of(metric));
  const Json json = {{"spec", o.spec},
                     {"title", o.title},
                     {"baseline", o.baseline},
                     {"models", o.models},
                     {"methods", o.methods},
                     {"metrics", metrics},
                     {"sweep", o.sweep},
                     {"runs", o.runs},
                     {"heat_map_models", o.heat_map_models},
                     {"heat_map_range", o.heat_map_range}};
  return json.dump(1) + "\n";
}

Record record_from_json(const std::string& text, const std::string& path) {
  try {
    const Json json = Json::parse(text);
    Record r;
    json.at("id").get_to(r.id);
    json.at("status").get_to(r.status);
    json.at("spec").get_to(r.spec);
    json.at("model").get_to(r.model);
    json.at("method").get_to(r.method);
    json.at("arm").get_to(r.arm);
    json.at("seed").get_to(r.seed);
    json.at("swept").get_to(r.swept);
    json.at("settings").get_to(r.settings);
    for (const auto& [name, value] : json.at("metrics").items())
      if (value.is_number()) r.metrics[name] = value;  // null: a metric that has no value here
    json.at("provenance").get_to(r.provenance);
    return r;
  } catch (const nlohmann::json::exception& error) {
    throw IoError(path, std::string("not a run record: ") + error.what());
  }
}

Overview overview_from_json(const std::string& text, const std::string& path) {
  try {
    const Json json = Json::parse(text);
    Overview o;
    json.at("spec").get_to(o.spec);
    json.at("title").get_to(o.title);
    json.at("baseline").get_to(o.baseline);
    json.at("models").get_to(o.models);
    json.at("methods").get_to(o.methods);
    for (const Json& metric : json.at("metrics")) o.metrics.push_back(metric_from(metric));
    json.at("sweep").get_to(o.sweep);
    json.at("heat_map_models").get_to(o.heat_map_models);
    json.at("heat_map_range").get_to(o.heat_map_range);
    json.at("runs").get_to(o.runs);
    return o;
  } catch (const nlohmann::json::exception& error) {
    throw IoError(path, std::string("not an overview of results: ") + error.what());
  }
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
      records.back().folder = fs::relative(file.parent_path(), folder.parent_path()).string();
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

Results load_results(const fs::path& folder) {
  Results results;
  results.overview = load_overview(folder);
  results.records = load_records(folder, results.complaints);
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
