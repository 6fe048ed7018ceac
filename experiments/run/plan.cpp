#include "run/plan.h"

#include <set>

#include "run/hash.h"
#include "run/metrics.h"
#include "run/models.h"

namespace carve::experiments {
namespace {

// Every combination of the swept values, the last field fastest.
std::vector<Settings> combinations(const Spec& spec) {
  std::vector<Settings> all = {{}};
  for (const auto& [field, values] : spec.sweep) {
    std::vector<Settings> longer;
    for (const Settings& partial : all)
      for (const std::string& value : values) {
        longer.push_back(partial);
        longer.back()[field] = value;
      }
    all = std::move(longer);
  }
  return all;
}

// Those that a method follows: it does not follow what it states itself.
Settings followed(Settings swept, const MethodSpec& method) {
  std::erase_if(swept, [&](const auto& entry) { return method.settings.contains(entry.first); });
  return swept;
}

std::string folder_of(std::string text) {
  for (char& c : text)
    if (c == '/') c = '_';
  return text;
}

// "Grid size against time (Fig. 4.10)"
std::string heading_of(const Spec& spec) {
  std::string thesis;
  for (const std::string& what : spec.thesis) thesis += (thesis.empty() ? "" : ", ") + what;
  return thesis.empty() ? spec.title : spec.title + " (" + thesis + ")";
}

}  // namespace

std::vector<Cell> plan(const Spec& spec) {
  std::vector<Cell> cells;
  const std::vector<Settings> sweeps = combinations(spec);
  for (const std::string& model : expand_subjects(spec.models)) {
    const std::string content = content_hash(make_subject(model));
    std::set<std::pair<std::string, Settings>> planned;
    for (const Settings& combination : sweeps)
      for (const MethodSpec& method : spec.methods) {
        const Settings swept = followed(combination, method);
        if (!planned.emplace(method.name, swept).second) continue;
        for (const unsigned seed : spec.seeds) {
          Cell cell{.model = model, .method = method.name, .arm = method.arm, .swept = swept, .seed = seed};
          cell.settings = spec.options;
          for (const Settings& over : {method.settings, swept})
            for (const auto& [field, value] : over) cell.settings[field] = value;
          cell.path = std::filesystem::path(spec.name) / folder_of(model) / folder_of(method.name);
          if (!swept.empty()) cell.path /= folder_of(text_of(swept));
          cell.path /= "seed=" + std::to_string(seed);
          cell.id = Hash()
                        .add(program_hash())
                        .add(content)
                        .add(method.arm)
                        .add(text_of(cell.settings))
                        .add(std::to_string(seed))
                        .hex();
          cells.push_back(std::move(cell));
        }
      }
  }
  return cells;
}

Overview overview(const Spec& spec, const std::vector<Cell>& cells) {
  Overview o{.spec = spec.name,
             .title = heading_of(spec),
             .baseline = spec.baseline,
             .thesis = spec.thesis,
             .models = expand_subjects(spec.models),
             .methods = {},
             .sweep = {},
             .heat_map_models = expand_subjects(spec.heat_map_models),
             .render_models = expand_subjects(spec.render_models),
             .metrics = {},
             .heat_map_range = spec.heat_map_range,
             .published = spec.published,
             .runs = {}};
  for (const Cell& cell : cells) o.runs.push_back(cell.path.string());
  for (const std::string& name : spec.metrics) {
    if (name == kEveryStage)  // those known here in their order; the others when results are read
      for (const RunMetric& metric : metrics())
        if (metric.name.starts_with("seconds_") && metric.name != kEveryStage) o.metrics.push_back(metric);
    o.metrics.push_back(*find_metric(name));
  }
  for (const MethodSpec& method : spec.methods) o.methods.push_back(method.name);
  for (const auto& [field, values] : spec.sweep) o.sweep.push_back(field);
  return o;
}

std::vector<Cell> shard(const std::vector<Cell>& cells, int index, int count) {
  std::vector<Cell> part;
  for (std::size_t i = index; i < cells.size(); i += count) part.push_back(cells[i]);
  return part;
}

}  // namespace carve::experiments
