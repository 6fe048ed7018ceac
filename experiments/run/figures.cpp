#include "run/figures.h"

#include <algorithm>

namespace carve::experiments {
namespace {

std::vector<const Record*> runs_of(const std::vector<Record>& records, const Overview& overview,
                                   const std::string& model, const Settings& swept) {
  std::vector<const Record*> runs;
  for (const std::string& method : overview.methods)
    for (const Record& r : records)
      if (r.model == model && r.method == method && r.swept == swept && r.done()) {
        runs.push_back(&r);
        break;
      }
  return runs;
}

}  // namespace

std::vector<Figure> figures_of(const Overview& overview, const std::vector<Record>& records,
                               const std::vector<std::string>& models) {
  std::vector<Figure> figures;
  for (const std::string& model : models) {
    std::vector<Settings> seen;
    for (const Record& record : records) {
      if (record.model != model || !record.done()) continue;
      if (std::find(seen.begin(), seen.end(), record.swept) != seen.end()) continue;
      seen.push_back(record.swept);
      std::string file = model + (record.swept.empty() ? "" : "," + text_of(record.swept)) + ".png";
      std::replace(file.begin(), file.end(), '/', '_');
      figures.push_back({file, runs_of(records, overview, model, record.swept)});
    }
  }
  return figures;
}

}  // namespace carve::experiments
