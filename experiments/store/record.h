#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace carve::experiments {

/// Field name -> value as text, e.g. {"smooth.steps", "4"}; names and ranges are those of run/settings.h.
using Settings = std::map<std::string, std::string>;

/// "a=1,b=2"
std::string text_of(const Settings& settings);

enum class Direction { lower, higher, none };  // which is better

/// A column of a table: its legend, its best entry, its plot's axis.
struct RunMetric {
  std::string name, formula, unit;
  Direction better = Direction::none;
};

/// A column that stands for the wall time of every stage that any run recorded, whichever stages the methods have.
inline constexpr const char* kEveryStage = "seconds_*";

/// What a run left in its folder (run.json).
struct Record {
  std::string id = {}, spec = {}, model = {}, method = {}, arm = {};
  std::string status = {};  // "done", or why there is no result
  Settings swept = {}, settings = {};
  unsigned seed = 1;
  std::map<std::string, double> metrics = {};          // by RunMetric::name
  std::map<std::string, std::string> provenance = {};  // commit, compiler, libraries, CPU
  std::string folder = {};                             // where it was read from, relative to the results; not stored
  bool done() const { return status == "done"; }
};

/// How the status of a run begins that needs a program which is not installed.
inline constexpr const char* kNotInstalled = "not installed";

/// The published table that a spec measures again: papers/published/TABLE.csv, whose rows are our models or methods.
struct Published {
  std::string table, method;  // the method whose runs are set beside it, unless the rows are methods
  Settings columns;           // published column -> our metric
};

/// What a spec's results are about (overview.json beside its runs), so that tables and plots need nothing else.
struct Overview {
  std::string spec, title, baseline;
  std::vector<std::string> thesis;  // what of the thesis it makes again: "Table 4.3"
  std::vector<std::string> models, methods, sweep, heat_map_models, render_models;  // in the spec's order
  std::vector<RunMetric> metrics;
  double heat_map_range = 2;
  Published published = {};
  std::vector<std::string> runs = {};  // their folders, relative to the results
};

inline constexpr const char* kReferences = "references";  // folders below the results
inline constexpr const char* kConceptArt = "concept_art";
inline constexpr const char* kReferenceKey = "reference";  // in a record's provenance: the file's name without .ply
inline constexpr const char* kRecordFile = "run.json";
inline constexpr const char* kOverviewFile = "overview.json";

std::string to_json(const Record& record);
std::string to_json(const Overview& overview);
/// \throws IoError naming `path`
Record record_from_json(const std::string& json, const std::string& path);
Overview overview_from_json(const std::string& json, const std::string& path);

/// All records below a spec's folder, sorted by path; what cannot be read is told in `complaints`.
std::vector<Record> load_records(const std::filesystem::path& folder, std::vector<std::string>& complaints);
Overview load_overview(const std::filesystem::path& folder);

/// What the runs of a spec left in its folder; kEveryStage has become the stages that any of them had.
struct Results {
  Overview overview;
  std::vector<Record> records;  // a run each; those that the spec no longer has are left out
  std::vector<Record> rows;     // the same, a run that states a swept field itself once for every value of that field
  std::vector<std::string> complaints;
};
Results load_results(const std::filesystem::path& folder);

/// The specs that have results below a folder, by name.
std::vector<std::string> specs_in(const std::filesystem::path& results);

}  // namespace carve::experiments
