#include <cstdio>
#include <nlohmann/json.hpp>
#include <ostream>

#include "eval/silhouette.h"

namespace carve {
namespace {

using Json = nlohmann::ordered_json;

Json number(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

std::string text(const std::optional<double>& value) {
  char buffer[32] = "-";
  if (value) std::snprintf(buffer, sizeof buffer, "%.4f", *value);
  return buffer;
}

}  // namespace

std::ostream& operator<<(std::ostream& out, const SilhouetteScores& scores) {
  out << "view    silhouette IoU  missing    extra  stroke precision   recall        F\n";
  for (const ViewScore& v : scores.views) {
    char line[160];
    std::snprintf(line, sizeof line, "%-6s  %14.4f  %7lld  %7lld  %16s  %7s  %7s\n", name(v.view), v.iou,
                  static_cast<long long>(v.missing), static_cast<long long>(v.extra), text(v.stroke_precision).c_str(),
                  text(v.stroke_recall).c_str(), text(v.stroke_f()).c_str());
    out << line;
  }
  return out << "missing, extra: pixels; strokes are compared away from the outline\n";
}

std::string to_json(const SilhouetteScores& scores) {
  Json views = Json::object();
  for (const ViewScore& v : scores.views)
    views[name(v.view)] = {{"silhouette_iou", v.iou},
                           {"missing", v.missing},
                           {"extra", v.extra},
                           {"stroke_precision", number(v.stroke_precision)},
                           {"stroke_recall", number(v.stroke_recall)},
                           {"stroke_f", number(v.stroke_f())}};
  const Json all = {
      {"fit", names(scores.fit)[static_cast<int>(scores.fit)]}, {"least_iou", scores.least_iou()}, {"views", views}};
  return all.dump();
}

}  // namespace carve
