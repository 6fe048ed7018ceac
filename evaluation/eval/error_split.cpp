#include "eval/error_split.h"

#include <cstdio>
#include <ostream>
#include <stdexcept>

namespace carve {
namespace {

CompareOptions distances_only(CompareOptions options) {
  options.iou_resolution = 0;
  options.self_intersections = false;
  return options;
}

double value_of(const std::string& name, const Comparison& comparison) {
  const auto value = metric(name).value(comparison, 0);
  if (!value) throw std::invalid_argument(name + " is not defined for a mesh without area");
  return *value;
}

}  // namespace

std::vector<Contribution> split_error(const Reference& reference, std::span<const Stage> stages,
                                      const std::string& name) {
  if (metric(name).unit != Unit::length || metric(name).better != Better::lower)
    throw std::invalid_argument("an error can be split by a length that should be low, not by " + name);
  if (stages.empty()) throw std::invalid_argument("an error is split over at least one stage, got none");
  const CompareOptions options = distances_only(reference.options());
  const Reference truth(reference.mesh(), options);
  std::vector<Contribution> split;
  double before = 0;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const double error = value_of(name, truth.compare(stages[i].mesh));
    Contribution part{stages[i].name, error - before, 100 * (error - before) / truth.diagonal()};
    if (i > 0) {
      const Comparison step = Reference(stages[i - 1].mesh, options).compare(stages[i].mesh);
      part.moved_mean = value_of("chamfer_l1", step);
      part.moved_max = value_of("hausdorff", step);
    }
    split.push_back(std::move(part));
    before = error;
  }
  return split;
}

std::ostream& operator<<(std::ostream& out, const std::vector<Contribution>& split) {
  char line[256];
  double value = 0, percent = 0;
  std::snprintf(line, sizeof line, "%-24s %12s %12s %12s %12s\n", "adds to the error", "model's unit", "of diagonal",
                "moved: mean", "max");
  out << line;
  for (const Contribution& part : split) {
    std::snprintf(line, sizeof line, "%-24s %12.6g %10.4f %% %12.6g %12.6g\n", part.name.c_str(), part.value,
                  part.percent, part.moved_mean, part.moved_max);
    out << line;
    value += part.value;
    percent += part.percent;
  }
  std::snprintf(line, sizeof line, "%-24s %12.6g %10.4f %%\n", "sum", value, percent);
  return out << line;
}

}  // namespace carve
